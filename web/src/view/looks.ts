import { Color, SRGBColorSpace } from 'three';
import type { FabricName, Look } from '../../../proto/js/messages.js';
import { difference } from './color.js';

/** How a fabric reflects light and lets it through. */
export interface Finish {
  /** Of a cloth that no colour was chosen for. */
  color: string;
  /** Of the back; absent: a paler or darker shade of the front. */
  back?: string;
  weave: FabricName;
  /** Of the weave: the distance after which it repeats to the eye [m]. */
  period: number;
  /** Slope of the weave in its normal map, and how much darker its grooves are, 0 to 1. */
  relief: number;
  grooves: number;
  /** Of the weft, between that of the warp (0) and white (1). */
  white_weft: number;
  roughness: number;
  back_roughness: number;
  /** Strength of reflections beside that of glass. */
  specular: number;
  /** How much longer highlights are along the weft than along the warp, 0 to 1. */
  anisotropy: number;
  sheen: number;
  sheen_roughness: number;
  /** Share of light that goes straight through, seen at a right angle. */
  clear: number;
  /** Share of diffuse light that leaves on the far side. */
  translucency: number;
  /** Half of the thickness of the edge [m]. */
  edge: number;
  /** Colour of stripes along the warp, if the fabric has any. */
  stripe?: string;
  /** Colour of the hem's seam; absent: darker than the cloth. */
  seam?: string;
}

const WOVEN: Finish = {
  color: '#b04a36',
  weave: 'plain',
  period: 0.004,
  relief: 0.8,
  grooves: 0.5,
  white_weft: 0,
  roughness: 0.85,
  back_roughness: 0.9,
  specular: 0.35,
  anisotropy: 0,
  sheen: 0.25,
  sheen_roughness: 0.6,
  clear: 0,
  translucency: 0.12,
  edge: 0.0009,
};

export const FINISHES: Record<FabricName, Finish> = {
  plain: WOVEN,
  cotton: {
    ...WOVEN,
    color: '#e4dccb',
    stripe: '#3f5f8f',
    weave: 'cotton',
    period: 0.003,
    relief: 0.6,
    grooves: 0.4,
    sheen: 0.15,
    translucency: 0.22,
    edge: 0.0008,
  },
  silk: {
    ...WOVEN,
    color: '#0f7f78',
    weave: 'silk',
    period: 0.001,
    relief: 0.16,
    grooves: 0.12,
    roughness: 0.32,
    back_roughness: 0.62,
    specular: 1,
    anisotropy: 0.55,
    sheen: 0.5,
    sheen_roughness: 0.3,
    clear: 0.1,
    translucency: 0.4,
    edge: 0.0005,
  },
  denim: {
    ...WOVEN,
    color: '#2b4a7d',
    back: '#a9b6c9',
    weave: 'denim',
    period: 0.0052,
    relief: 1,
    grooves: 0.6,
    white_weft: 0.55,
    roughness: 0.9,
    sheen: 0.12,
    specular: 0.25,
    translucency: 0,
    edge: 0.0014,
    seam: '#c98a3a',
  },
  wool: {
    ...WOVEN,
    color: '#b08a3c',
    weave: 'wool',
    period: 0.008,
    relief: 0.7,
    grooves: 0.45,
    roughness: 1,
    back_roughness: 1,
    specular: 0.1,
    sheen: 1,
    sheen_roughness: 0.75,
    translucency: 0.05,
    edge: 0.0016,
  },
  leather: {
    ...WOVEN,
    color: '#6e3d20',
    back: '#b58d66',
    weave: 'leather',
    period: 0.0042,
    relief: 0.55,
    grooves: 0.3,
    roughness: 0.48,
    back_roughness: 0.95,
    specular: 0.9,
    sheen: 0,
    translucency: 0,
    edge: 0.0012,
    seam: '#d8c39a',
  },
  nylon: {
    ...WOVEN,
    color: '#f07818',
    weave: 'nylon',
    period: 0.006,
    relief: 0.5,
    grooves: 0.25,
    roughness: 0.48,
    back_roughness: 0.5,
    specular: 1,
    sheen: 0.1,
    sheen_roughness: 0.4,
    clear: 0.14,
    translucency: 0.5,
    edge: 0.0004,
  },
};

/** Told apart from each other at a glance, also under uneven light. */
export const PALETTE = [
  '#b04a36',
  '#2c5d9e',
  '#e8b93a',
  '#2f7d4f',
  '#e8e2d4',
  '#6b3a7d',
  '#58b3c4',
  '#33363c',
  '#e58fa5',
  '#7a4a26',
  '#a6c34c',
  '#8d97a3',
  '#c43f86',
];

const CLEARLY_DIFFERENT = 30; // in CIELAB; twice what is needed under equal light

export function finish_of(look: Look | undefined): Finish {
  return FINISHES[look?.fabric ?? 'plain'] ?? WOVEN;
}

/**
 * Colours of the fronts of all cloths. Chosen ones stay; the others get that of their fabric, or
 * the first of the palette that differs clearly from all those of the scene.
 */
export function colors_of(looks: readonly (Look | undefined)[]): Color[] {
  const taken = looks.flatMap((look) => (look?.color ? [new Color(look.color)] : []));
  const apart = (color: Color) => Math.min(Infinity, ...taken.map((each) => difference(each, color)));
  return looks.map((look) => {
    if (look?.color) return new Color(look.color);
    const candidates = [finish_of(look).color, ...PALETTE].map((text) => new Color(text));
    const best = Math.max(...candidates.map(apart));
    const color = candidates.find((each) => apart(each) >= Math.min(best, CLEARLY_DIFFERENT))!;
    taken.push(color);
    return color;
  });
}

/** Colour of a cloth's back: the chosen one, that of its fabric, or another shade of the front. */
export function back_of(look: Look | undefined, front: Color): Color {
  if (look?.back) return new Color(look.back);
  const { color, back } = finish_of(look);
  if (back && front.equals(new Color(color))) return new Color(back);
  const { h, s, l } = front.getHSL({ h: 0, s: 0, l: 0 }, SRGBColorSpace);
  const lighter = l < 0.62;
  const saturation = s * (lighter ? 0.8 : 0.95);
  return new Color().setHSL(h, saturation, lighter ? l + 0.07 : l - 0.11, SRGBColorSpace);
}

import type { Cloth, Pin } from '../../../proto/js/messages.js';
import { circle, ruler } from './ruler.js';
import type { Point } from './ruler.js';

// A bundle of its own, of which only scenes that are tests have need: it imports nothing of the rest.

/** Which textile test a scene is. */
export type TextileTest = 'drape' | 'cantilever' | 'decay';

const DISC_RADIUS = 0.09; // of the drape test's support, by its standard [m]
const SPECIMEN_RADIUS = 0.15; // of a flat specimen [m]
const ABOVE_FLOOR = 0.001; // of lines on the floor [m]
const RULER_GAP = 0.015; // between a ruler and what it measures [m]
const ARC_PARTS = 12;
const SMOOTHINGS = 12; // of an outline: enough for the stairs in which a round cloth of a grid ends

/** What the marks are made of. */
export interface Specimen {
  positions: ArrayLike<number>;
  triangles: ArrayLike<number>;
  cloth: Cloth;
  /** The scene's own pin, which holds the specimen. */
  pin: Pin;
  /** Height of the floor [m]. */
  floor: number;
}

/** Edges of one triangle only: the cloth's border, two particles each. */
export function border(triangles: ArrayLike<number>, cloth: Cloth): number[] {
  const edges = new Map<number, [number, number]>();
  const { first_vertex, vertices } = cloth;
  const end = 3 * (cloth.first_triangle + cloth.triangles);
  for (let corner = 3 * cloth.first_triangle; corner < end; corner++) {
    const next = corner % 3 === 2 ? corner - 2 : corner + 1;
    const [a, b] = [triangles[corner], triangles[next]];
    const key = (Math.min(a, b) - first_vertex) * vertices + Math.max(a, b) - first_vertex;
    if (!edges.delete(key)) edges.set(key, [a, b]);
  }
  return [...edges.values()].flat();
}

/** The border's particles, one after the other. */
function outline({ triangles, cloth }: Specimen): number[] {
  const edges = border(triangles, cloth);
  const next = new Map<number, number>();
  for (let i = 0; i < edges.length; i += 2) next.set(edges[i], edges[i + 1]);
  const loop = [edges[0]];
  while (loop.length < next.size) loop.push(next.get(loop.at(-1)!)!);
  return loop;
}

/**
 * The shadow of the cloth's border on the floor under a lamp far above: pairs of points. The stairs in
 * which a grid ends are smoothed to a line through their middles, which has the same area inside.
 */
export function shadow(specimen: Specimen): number[] {
  const { positions, floor } = specimen;
  const loop = outline(specimen);
  const [x, z] = [0, 2].map((axis) => {
    let places = loop.map((i) => positions[3 * i + axis]);
    for (let k = 0; k < SMOOTHINGS; k++) places = smoothed(places);
    return places;
  });
  const at = (k: number) => [x.at(k)!, floor + ABOVE_FLOOR, z.at(k)!];
  return loop.flatMap((_, k) => [...at(k - 1), ...at(k)]);
}

/** Each number of a ring as half itself and half its neighbours. */
const smoothed = (ring: number[]) =>
  ring.map((value, k) => value / 2 + (ring.at(k - 1)! + ring[(k + 1) % ring.length]) / 4);

/** Where a strip is clamped and where its free end is, each the middle of its columns [m]. */
export function overhang({ positions, cloth, pin }: Specimen): { clamp: Point; tip: Point } {
  const [rows, columns] = [cloth.rows ?? 1, cloth.columns ?? cloth.vertices];
  const middle = (column: number): Point => {
    const sum: Point = [0, 0, 0];
    for (let row = 0; row < rows; row++) {
      const at = 3 * (cloth.first_vertex + row * columns + column);
      for (let axis = 0; axis < 3; axis++) sum[axis] += positions[at + axis] / rows;
    }
    return sum;
  };
  // The specimen is clamped at the last column that is held.
  const held = Math.max(1, Math.round(pin.count / rows));
  return { clamp: middle(held - 1), tip: middle(columns - 1) };
}

function drape_marks(specimen: Specimen): number[] {
  const [x, , z] = specimen.pin.position;
  const height = specimen.floor + ABOVE_FLOOR;
  const centre: Point = [x, height, z];
  const start: Point = [x - SPECIMEN_RADIUS, height, z + SPECIMEN_RADIUS + RULER_GAP];
  return [
    ...shadow(specimen),
    ...circle(centre, DISC_RADIUS),
    ...circle(centre, SPECIMEN_RADIUS),
    ...ruler(start, [1, 0, 0], [0, 0, 1], 2 * SPECIMEN_RADIUS),
  ];
}

/** The level and the chord from clamp to tip, the angle between them, and a ruler along the droop. */
function cantilever_marks(specimen: Specimen): number[] {
  const { clamp, tip } = overhang(specimen);
  const depth = half_width(specimen) + 0.002; // before the strip, seen from the side
  const [x, y, z] = [clamp[0], clamp[1], clamp[2] + depth];
  const [reach, droop] = [Math.hypot(tip[0] - x, tip[2] - clamp[2]), y - tip[1]];
  const angle = Math.atan2(droop, reach);
  const radius = 0.4 * Math.hypot(reach, droop);
  const arc: number[] = [];
  for (let part = 0; part < ARC_PARTS; part++) {
    for (const end of [part, part + 1]) {
      const turn = (angle * end) / ARC_PARTS;
      arc.push(x + radius * Math.cos(turn), y - radius * Math.sin(turn), z);
    }
  }
  const side = x + reach;
  return [
    ...[x, y, z, side, y, z], // the level
    ...[x, y, z, side, tip[1], z], // the chord
    ...arc,
    ...ruler([side, y, z], [0, -1, 0], [1, 0, 0], droop),
  ];
}

/** All marks of a test, as pairs of points. */
export function marks_of(test: TextileTest, specimen: Specimen): number[] {
  if (test === 'decay') return []; // what is measured is a time
  return test === 'drape' ? drape_marks(specimen) : cantilever_marks(specimen);
}

function half_width({ positions, cloth }: Specimen): number {
  const first = 3 * cloth.first_vertex;
  const last = first + 3 * (cloth.rows! - 1) * cloth.columns!;
  return Math.abs(positions[last + 2] - positions[first + 2]) / 2;
}

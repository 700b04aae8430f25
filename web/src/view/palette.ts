import { Color } from 'three';

export type Theme = 'light' | 'dark';

/** Colours of the studio around the cloth. */
export interface Palette {
  floor: Color;
  /** Of the backdrop, above the horizon. */
  sky: Color;
  grid: Color;
  shadow: Color;
  /** Part of the floor's light that a full shadow takes. */
  shade: number;
}

/** Quiet greys: what has a colour in the picture is the cloth. */
export const PALETTES: Record<Theme, Palette> = {
  light: {
    floor: new Color('#cdc9c1'),
    sky: new Color('#eceae5'),
    grid: new Color('#8d8980'),
    shadow: new Color('#2b2622'),
    shade: 0.46,
  },
  dark: {
    floor: new Color('#2c2d30'),
    sky: new Color('#1b1c1f'),
    grid: new Color('#56585d'),
    shadow: new Color('#060607'),
    shade: 0.62,
  },
};

import { Color } from 'three';

/** CIELAB of a colour, for the white of sRGB (D65). */
export function lab_of(color: Color): [number, number, number] {
  const { r, g, b } = color; // linear, as three keeps them
  const x = (0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505;
  const y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
  const z = (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089;
  const root = (t: number) => (t > 216 / 24389 ? Math.cbrt(t) : (24389 / 27 * t + 16) / 116);
  const [fx, fy, fz] = [root(x), root(y), root(z)];
  return [116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)];
}

/** Difference of two colours: their distance in CIELAB (CIE 1976). About 2 is just noticed. */
export function difference(one: Color, other: Color): number {
  const [a, b] = [lab_of(one), lab_of(other)];
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

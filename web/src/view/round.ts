import { border_of, corners_of } from './border.js';

const LEAST_CORNERS = 12; // of a staircase; a rectangle has four
const INNERMOST = 0.7; // place of a border's vertices, as a part of the radius
const OUTERMOST = 1.15; // a rectangle’s corner is at 1.4

/** An ellipse in the plane of a cloth, along u and v. */
export interface Round {
  center: [number, number];
  radii: [number, number];
}

/**
 * A round cloth of a grid ends in stairs, from cell to cell. It is drawn round instead: as the largest
 * ellipse that its triangles fill. Null if the border is no such staircase.
 * @param uv two values per vertex
 */
export function round_of(triangles: Uint32Array, uv: Float32Array): Round | null {
  if (corners_of(triangles, uv).size < LEAST_CORNERS) return null;
  const border = [...border_of(triangles)];
  const sides = [0, 1].map((axis) => border.map(([vertex]) => uv[vertex * 2 + axis]));
  const lows = sides.map((values) => Math.min(...values));
  const highs = sides.map((values) => Math.max(...values));
  const center = lows.map((low, axis) => (low + highs[axis]) / 2) as [number, number];
  const radii = lows.map((low, axis) => (highs[axis] - low) / 2) as [number, number];
  const place = (vertex: number) => radii.map((radius, axis) => (uv[vertex * 2 + axis] - center[axis]) / radius);
  const away = border.map(([vertex]) => Math.hypot(...place(vertex)));
  if (Math.min(...away) < INNERMOST || Math.max(...away) > OUTERMOST) return null;
  const inner = Math.min(...border.map(([a, b]) => distance_of_line(place(a), place(b))));
  return { center, radii: radii.map((radius) => radius * inner) as [number, number] };
}

/** Distance of a line between two points from the origin. */
function distance_of_line([ax, ay]: number[], [bx, by]: number[]): number {
  const [dx, dy] = [bx - ax, by - ay];
  const part = Math.min(1, Math.max(0, -(ax * dx + ay * dy) / (dx * dx + dy * dy)));
  return Math.hypot(ax + part * dx, ay + part * dy);
}

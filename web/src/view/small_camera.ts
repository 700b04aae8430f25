import type { Vec3, View } from '../../../proto/js/messages.js';

const SLOPE = Math.tan((18 * Math.PI) / 180); // of half the angle of view
const USUAL_DIRECTION: Vec3 = [0, 0.35, 0.94]; // where a scene has no view of its own

/** From where a small picture sees: all of the scene's view, or of a cloth that has left it. */
export function small_camera(
  view: View | undefined,
  positions: Float32Array,
  aspect: number,
): { eye: Vec3; matrix: Float32Array } {
  const cloth = ball_around(positions);
  const away = view ? Math.hypot(...cloth.target.map((x, axis) => x - view.target[axis])) : Infinity;
  const { target, radius } = view && away < view.radius ? view : cloth;
  const back = unit(view?.direction ?? USUAL_DIRECTION);
  const opening = Math.min(SLOPE, SLOPE * aspect);
  const distance = (radius * Math.hypot(1, opening)) / opening;
  const eye = target.map((x, axis) => x + distance * back[axis]) as Vec3;
  return { eye, matrix: seen_from(eye, back, aspect, distance) };
}

/** Around the middle of the positions' box. */
function ball_around(positions: Float32Array): { target: Vec3; radius: number } {
  const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  positions.forEach((x, i) => {
    low[i % 3] = Math.min(low[i % 3], x);
    high[i % 3] = Math.max(high[i % 3], x);
  });
  const target = low.map((x, axis) => (x + high[axis]) / 2) as Vec3;
  return { target, radius: Math.max(1e-3, Math.hypot(...low.map((x, axis) => high[axis] - x)) / 2) };
}

/** Projection and view in one, by columns. */
function seen_from(eye: Vec3, back: Vec3, aspect: number, distance: number): Float32Array {
  const level = Math.hypot(back[0], back[2]) > 1e-6;
  const right: Vec3 = level ? unit([back[2], 0, -back[0]]) : [1, 0, 0];
  const up: Vec3 = [
    back[1] * right[2] - back[2] * right[1],
    back[2] * right[0] - back[0] * right[2],
    back[0] * right[1] - back[1] * right[0],
  ];
  const [near, far] = [distance / 50, distance * 8];
  const [depth, shift] = [(far + near) / (near - far), (2 * far * near) / (near - far)];
  const dot = (a: Vec3) => a[0] * eye[0] + a[1] * eye[1] + a[2] * eye[2];
  const row = (a: Vec3, scale: number) => [...a.map((x) => x * scale), -dot(a) * scale];
  const rows = [row(right, 1 / (SLOPE * aspect)), row(up, 1 / SLOPE), row(back, depth), row(back, -1)];
  rows[2][3] += shift;
  return Float32Array.from({ length: 16 }, (_, i) => rows[i % 4][Math.floor(i / 4)]);
}

function unit(vector: Vec3): Vec3 {
  const length = Math.hypot(...vector) || 1;
  return vector.map((x) => x / length) as Vec3;
}

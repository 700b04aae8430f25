import type { Vec3 } from '../../../proto/js/messages.js';

export interface ClothHit {
  triangle: number;
  barycentric: Vec3;
  position: Vec3;
  /** From the ray's origin, in lengths of its direction. */
  distance: number;
  /** The corner with the largest weight. */
  particle: number;
}

/**
 * First triangle that the ray meets, from either side (Möller and Trumbore 1997). It only decides
 * whether the pointer is on the drawn cloth; the server decides what is held.
 * @param positions three values per vertex [m]
 * @param triangles three vertices per triangle
 */
export function cast_ray(
  origin: Vec3,
  direction: Vec3,
  positions: Float32Array,
  triangles: Uint32Array,
): ClothHit | null {
  const [ox, oy, oz] = origin;
  const [dx, dy, dz] = direction;
  let nearest = Infinity;
  let found = -1;
  let found_u = 0;
  let found_v = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const a = triangles[t] * 3;
    const b = triangles[t + 1] * 3;
    const c = triangles[t + 2] * 3;
    const ax = positions[a];
    const ay = positions[a + 1];
    const az = positions[a + 2];
    const e1x = positions[b] - ax;
    const e1y = positions[b + 1] - ay;
    const e1z = positions[b + 2] - az;
    const e2x = positions[c] - ax;
    const e2y = positions[c + 1] - ay;
    const e2z = positions[c + 2] - az;
    const px = dy * e2z - dz * e2y;
    const py = dz * e2x - dx * e2z;
    const pz = dx * e2y - dy * e2x;
    const determinant = e1x * px + e1y * py + e1z * pz;
    if (determinant === 0) continue;
    const sx = ox - ax;
    const sy = oy - ay;
    const sz = oz - az;
    const u = (sx * px + sy * py + sz * pz) / determinant;
    if (!(u >= 0 && u <= 1)) continue;
    const qx = sy * e1z - sz * e1y;
    const qy = sz * e1x - sx * e1z;
    const qz = sx * e1y - sy * e1x;
    const v = (dx * qx + dy * qy + dz * qz) / determinant;
    if (!(v >= 0 && u + v <= 1)) continue;
    const distance = (e2x * qx + e2y * qy + e2z * qz) / determinant;
    if (distance > 0 && distance < nearest) {
      nearest = distance;
      found = t / 3;
      found_u = u;
      found_v = v;
    }
  }
  if (found < 0) return null;
  const barycentric: Vec3 = [Math.max(0, 1 - found_u - found_v), found_u, found_v];
  const corner = barycentric.indexOf(Math.max(...barycentric));
  return {
    triangle: found,
    barycentric,
    position: [ox + dx * nearest, oy + dy * nearest, oz + dz * nearest],
    distance: nearest,
    particle: triangles[found * 3 + corner],
  };
}

/** The point of a triangle with these weights. */
export function point_on_triangle(
  triangle: number,
  weights: readonly number[],
  positions: Float32Array,
  triangles: Uint32Array,
): Vec3 {
  const point: Vec3 = [0, 0, 0];
  for (let corner = 0; corner < 3; corner++) {
    const vertex = triangles[triangle * 3 + corner] * 3;
    for (let axis = 0; axis < 3; axis++) point[axis] += weights[corner] * positions[vertex + axis];
  }
  return point;
}

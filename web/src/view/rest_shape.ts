import type { Cloth, MeshData } from '../../../proto/js/messages.js';

/**
 * Width and height of a cloth in its plane [m]: the scales of u and v with which its edges have
 * their lengths at rest, by least squares.
 */
export function fabric_extent(cloth: Cloth, data: MeshData): [number, number] {
  const { restPositions, triangles, uv } = data;
  let [uu, uv_, vv, ul, vl] = [0, 0, 0, 0, 0];
  const end = (cloth.first_triangle + cloth.triangles) * 3;
  for (let t = cloth.first_triangle * 3; t < end; t++) {
    const a = triangles[t];
    const b = triangles[t % 3 === 2 ? t - 2 : t + 1];
    const u = (uv[a * 2] - uv[b * 2]) ** 2;
    const v = (uv[a * 2 + 1] - uv[b * 2 + 1]) ** 2;
    let length = 0;
    for (let axis = 0; axis < 3; axis++) {
      length += (restPositions[a * 3 + axis] - restPositions[b * 3 + axis]) ** 2;
    }
    uu += u * u;
    uv_ += u * v;
    vv += v * v;
    ul += u * length;
    vl += v * length;
  }
  const determinant = uu * vv - uv_ * uv_;
  const width = (ul * vv - vl * uv_) / determinant;
  const height = (vl * uu - ul * uv_) / determinant;
  return [Math.sqrt(width) || 1, Math.sqrt(height) || 1];
}

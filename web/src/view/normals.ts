/**
 * Vertex normals: means of the triangles' normals, weighted by area.
 * @param normals out; three values per vertex, of unit length; may be longer than the positions
 */
export function smooth_normals(
  positions: Float32Array,
  triangles: Uint32Array,
  normals: Float32Array,
): void {
  normals.fill(0);
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
    const nx = e1y * e2z - e1z * e2y;
    const ny = e1z * e2x - e1x * e2z;
    const nz = e1x * e2y - e1y * e2x;
    normals[a] += nx;
    normals[a + 1] += ny;
    normals[a + 2] += nz;
    normals[b] += nx;
    normals[b + 1] += ny;
    normals[b + 2] += nz;
    normals[c] += nx;
    normals[c + 1] += ny;
    normals[c + 2] += nz;
  }
  normalise(normals);
}

function normalise(normals: Float32Array): void {
  // The root of a sum of squares: Math.hypot guards against overflow and takes four times as long.
  for (let i = 0; i < normals.length; i += 3) {
    const x = normals[i];
    const y = normals[i + 1];
    const z = normals[i + 2];
    const inverse = 1 / (Math.sqrt(x * x + y * y + z * z) || 1);
    normals[i] = x * inverse;
    normals[i + 1] = y * inverse;
    normals[i + 2] = z * inverse;
  }
}

/**
 * Evens out normals with those of neighbours. Folds narrower than two particles are zigzags, which
 * light would show as rows of dents.
 * @param triangles of the vertices, each cell by both of its diagonals
 * @param normals   in and out; of unit length
 * @returns of each vertex, how far the normals around it agree: 1 in a plane, 0 where they cancel out
 */
export function even_normals(triangles: Uint32Array, normals: Float32Array): Float32Array {
  const sums = new Float32Array(normals.length);
  const agreement = new Float32Array(normals.length / 3); // at first how many normals there are
  for (const vertex of triangles) agreement[vertex] += 3;
  for (let t = 0; t < triangles.length; t += 3) {
    const a = triangles[t] * 3;
    const b = triangles[t + 1] * 3;
    const c = triangles[t + 2] * 3;
    for (let axis = 0; axis < 3; axis++) {
      const sum = normals[a + axis] + normals[b + axis] + normals[c + axis];
      sums[a + axis] += sum;
      sums[b + axis] += sum;
      sums[c + axis] += sum;
    }
  }
  for (let k = 0, i = 0; k < agreement.length; k++, i += 3) {
    const length = Math.sqrt(sums[i] * sums[i] + sums[i + 1] * sums[i + 1] + sums[i + 2] * sums[i + 2]);
    agreement[k] = length / (agreement[k] || 1);
    for (let axis = 0; axis < 3; axis++) normals[i + axis] = sums[i + axis] / (length || 1);
  }
  return agreement;
}

/** Positions moved inwards along the smooth normals by a distance [m]. */
export function inner_offset(
  positions: Float32Array,
  triangles: Uint32Array,
  distance: number,
): Float32Array {
  const normals = new Float32Array(positions.length);
  smooth_normals(positions, triangles, normals);
  return positions.map((value, i) => value - normals[i] * distance);
}

import { import_page_module } from './page_module.mjs';

// Grids of cloth, and the finer mesh of them that the page draws.

const { roundness, Subdivision } = await import_page_module('view/subdivision');
const { corners_of } = await import_page_module('view/border');
const { both_diagonals, cells_of } = await import_page_module('view/cells');
const { even_normals, smooth_normals } = await import_page_module('view/normals');

/** Positions, uv and triangles of a grid of n by n vertices with alternating diagonals. */
export function grid(n, place) {
  const points = Array.from({ length: n * n }, (_, k) => [(k % n) / (n - 1), Math.floor(k / n) / (n - 1)]);
  const triangles = [];
  for (let row = 0; row < n - 1; row++) {
    for (let column = 0; column < n - 1; column++) {
      const [a, b] = [row * n + column, row * n + column + 1];
      const [c, d] = [a + n, b + n];
      triangles.push(...((row + column) % 2 ? [a, b, c, b, d, c] : [a, b, d, a, d, c]));
    }
  }
  const positions = Float32Array.from(points.flatMap(([u, v]) => place(u, v)));
  return { positions, uv: Float32Array.from(points.flat()), triangles: Uint32Array.from(triangles) };
}

/** Refines a grid as the page does. @param even whether normals are evened out too, and folds left sharp */
export function refined({ positions, triangles, uv }, levels, reach, even = false) {
  const cells = cells_of(triangles, uv);
  const fine = new Subdivision(positions.length / 3, triangles, cells, corners_of(triangles, uv), levels);
  const points = new Float32Array(fine.vertices * 3);
  points.set(positions);
  const normals = new Float32Array(points.length);
  const [both, coarse] = [both_diagonals(triangles, cells), normals.subarray(0, positions.length)];
  smooth_normals(points, both, coarse);
  const most = new Float32Array(fine.vertices).fill(reach);
  if (even) for (const [k, value] of even_normals(both, coarse).entries()) most[k] *= roundness(value);
  fine.refine(points, normals, most);
  return { fine, points, normals };
}

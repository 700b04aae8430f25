/**
 * Pairs of triangles that are the halves of a cell between two threads of the warp and two of the
 * weft. Which diagonal divides a cell is chance to the eye: what is drawn uses both.
 * @param uv two values per vertex
 * @returns four vertices per cell: the ends of its diagonal, then the other two
 */
export function cells_of(triangles: Uint32Array, uv: Float32Array): Uint32Array {
  const vertices = uv.length / 2;
  const opposite = new Map<number, number>();
  const cells: number[] = [];
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; k++) {
      const a = triangles[t + k];
      const b = triangles[t + ((k + 1) % 3)];
      const c = triangles[t + ((k + 2) % 3)];
      const d = opposite.get(b * vertices + a);
      if (d === undefined) opposite.set(a * vertices + b, c);
      else if (is_cell(uv, a, b, c, d)) cells.push(a, b, c, d);
    }
  }
  return Uint32Array.from(cells);
}

/** Whether a and b, c and d are opposite corners of a rectangle along the threads. */
function is_cell(uv: Float32Array, a: number, b: number, c: number, d: number): boolean {
  const [au, av, bu, bv] = [uv[a * 2], uv[a * 2 + 1], uv[b * 2], uv[b * 2 + 1]];
  const near = 1e-3 * Math.max(Math.abs(au - bu), Math.abs(av - bv));
  const is = (k: number, u: number, v: number) =>
    Math.abs(uv[k * 2] - u) < near && Math.abs(uv[k * 2 + 1] - v) < near;
  return (is(c, au, bv) && is(d, bu, av)) || (is(c, bu, av) && is(d, au, bv));
}

/** The triangles, and those of the cells' other diagonals. */
export function both_diagonals(triangles: Uint32Array, cells: Uint32Array): Uint32Array {
  const all = new Uint32Array(triangles.length + cells.length * 1.5);
  all.set(triangles);
  for (let k = 0, to = triangles.length; k < cells.length; k += 4, to += 6) {
    const [a, b, c, d] = cells.subarray(k, k + 4);
    all.set([a, d, c, d, b, c], to);
  }
  return all;
}

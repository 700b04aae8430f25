import assert from 'node:assert/strict';
import test from 'node:test';
import { grid, refined } from './support/grids.mjs';
import { import_page_module } from './support/page_module.mjs';

// Stripes on the finer mesh, and the order in which cloths are drawn, without a browser.

const { ClothMesh } = await import_page_module('view/cloth_mesh');
const { StripeCurves } = await import_page_module('view/stripe_curves');

/** The pattern of a square grid of n by n, finer by two levels, as its stripes are drawn: points and uv. */
function striped(n, place) {
  const mesh = grid(n, place);
  const { fine, points } = refined(mesh, 2, 1);
  const straight = new Float32Array(fine.vertices * 2);
  straight.set(mesh.uv);
  fine.interpolate(straight, 2);
  const uv = straight.slice();
  const made = Uint32Array.from({ length: fine.vertices - n * n }, (_, k) => n * n + k);
  const curves = new StripeCurves({ first_vertex: 0, rows: n, columns: n }, made, uv, [1, 1], 4);
  curves.place(points, uv);
  return { points, straight, uv, curves };
}

test('stripes of a cloth that bends in its plane are eight times nearer to smooth curves than its rows', () => {
  const bow = (u) => 0.04 * Math.sin(7 * u);
  const turned = (x, y) => [0.6 * x, y, 0.8 * x]; // not along the axes
  const { points, straight, uv, curves } = striped(11, (u, v) => turned(u, v + bow(u)));
  const off = (pattern) => {
    let most = 0;
    for (let k = 0; k < pattern.length / 2; k++) {
      const [u, v] = straight.subarray(k * 2, k * 2 + 2);
      if (Math.min(u, v, 1 - u, 1 - v) < 0.11) continue; // rows go straight on at their ends
      const [x, y, z] = points.subarray(k * 3, k * 3 + 3);
      most = Math.max(most, Math.abs(pattern[k * 2 + 1] - (y - bow(0.6 * x + 0.8 * z))));
    }
    return most;
  };
  assert.ok(off(straight) > 0.002, `${off(straight)}`);
  assert.ok(off(uv) < off(straight) / 8, `${off(uv)} of ${off(straight)}`);
  curves.straighten(uv);
  assert.deepEqual(uv, straight);
});

test('stripes stay where they are in a cloth that is sheared, folded along its rows or creased across them', () => {
  const folded = (u, v) => [u, 0.5 * v, 0.2 * Math.abs(v - 0.5)];
  const creased = (u, v) => [0.5 * u, v, 0.2 * Math.abs(u - 0.5)];
  for (const place of [(u, v) => [u + 0.3 * v, v - 0.2 * u, u], folded, creased]) {
    const { straight, uv } = striped(9, place);
    for (const [k, value] of uv.entries()) assert.ok(Math.abs(value - straight[k]) < 1e-5, `${value}`);
  }
});

test('of cloths that one sees through the farther is drawn first, from whichever side one looks', () => {
  const sheet = grid(5, (u, v) => [u, v, 0]);
  const [vertices, triangles] = [25, sheet.triangles.length / 3];
  const cloths = [0, 1].map((k) => ({
    first_vertex: k * vertices, first_triangle: k * triangles, vertices, triangles, thickness: 0.002,
    look: { fabric: 'silk' },
  }));
  const twice = (values, change) => [...values, ...values.map(change)];
  const mesh = new ClothMesh(cloths, {
    restPositions: Float32Array.from(twice([...sheet.positions], (value, k) => (k % 3 === 2 ? value - 1 : value))),
    triangles: Uint32Array.from(twice([...sheet.triangles], (vertex) => vertex + vertices)),
    uv: Float32Array.from(twice([...sheet.uv], (value) => value)),
    colliders: [],
  });
  const orders = [1, -1].map((side) => {
    const elements = [side, 0, 0, 0, 0, 1, 0, 0, 0, 0, side, 0, 0, 0, -3, 1];
    mesh.sort({ matrixWorldInverse: { elements } });
    return mesh.group.children.map(({ renderOrder }) => renderOrder);
  });
  assert.ok(orders[0][1] < orders[0][0], `${orders[0]}: the second is farther from the front`);
  assert.ok(orders[1][0] < orders[1][1], `${orders[1]}: the first from behind`);
  assert.ok(Math.max(...orders.flat()) < 1, 'and marks come after all');
});

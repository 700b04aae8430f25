import assert from 'node:assert/strict';
import test from 'node:test';
import { grid } from './support/grids.mjs';
import { import_page_module } from './support/page_module.mjs';

// The order in which cloths are drawn, without a browser.

const { ClothMesh } = await import_page_module('view/cloth_mesh');

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

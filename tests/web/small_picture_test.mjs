import assert from 'node:assert/strict';
import test from 'node:test';
import { import_page_module } from './support/page_module.mjs';

// What the wall of rooms is made of, without a browser: names of copies, shapes, and from where a room is seen.

const { copy_names, small_shape, small_camera } = await import_page_module(
  'panel/room_copy',
  'view/small_shapes',
  'view/small_camera',
);

function first(names, count) {
  return Array.from({ length: count }, () => names.next().value);
}

test('names of copies are ones that a server takes, after the viewer, and each another', () => {
  for (const [viewer, best] of [
    ['Ada', 'ada'],
    ['Zoë Müller', 'zoe-muller'],
    ['viewer 12', 'viewer-12'],
    ['李四', 'copy'],
    ['- _ -', 'copy'],
    ['Maximilian-Alexander von Weft 32', 'maximilian-alexander-von'],
    ['default', 'default-2'],
  ]) {
    const names = first(copy_names(viewer), 70);
    assert.equal(names[0], best);
    assert.equal(new Set(names).size, names.length);
    for (const name of names) assert.match(name, /^[a-z0-9][a-z0-9-]{0,31}$/);
  }
});

/** By the divergence theorem; positive if triangles are counter-clockwise from outside. */
function volume({ positions, triangles }) {
  let sum = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => positions.slice(triangles[t + k] * 3, triangles[t + k] * 3 + 3));
    sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum / 6;
}

/** Edges that not exactly two triangles share, of shapes whose corners are told apart by their place. */
function open_edges({ positions, triangles }) {
  const place = (corner) => [0, 1, 2].map((axis) => (positions[corner * 3 + axis] + 0).toFixed(5).replace('-0.00000', '0.00000')).join();
  const seen = new Map();
  for (let t = 0; t < triangles.length; t += 3) {
    for (const k of [0, 1, 2]) {
      const ends = [place(triangles[t + k]), place(triangles[t + ((k + 1) % 3)])];
      if (ends[0] === ends[1]) continue;
      const edge = ends.sort().join(' ');
      seen.set(edge, (seen.get(edge) ?? 0) + 1);
    }
  }
  return [...seen].filter(([, count]) => count % 2 === 1).length;
}

const COLLIDERS = [
  { kind: 'sphere', center: [0.3, -1, 2], radius: 0.5 },
  { kind: 'capsule', a: [0, 1, 0], b: [0, 2.5, 0], radius: 0.25 },
  { kind: 'capsule', a: [1, 1, 0], b: [-1, 1.5, 0.7], radius: 0.1 },
  { kind: 'box', center: [1, 0.2, -1], half_extents: [0.2, 0.1, 0.4], orientation: [0, 0, 0, 1] },
  { kind: 'box', center: [1, 0.2, -1], half_extents: [0.2, 0.1, 0.4], orientation: [0.5, 0.5, -0.5, 0.5] },
];

function volume_of({ kind, a, b, radius, half_extents }) {
  if (kind === 'box') return 8 * half_extents[0] * half_extents[1] * half_extents[2];
  const length = kind === 'sphere' ? 0 : Math.hypot(...a.map((x, axis) => x - b[axis]));
  return Math.PI * radius ** 2 * ((4 / 3) * radius + length);
}

test('shapes of small pictures are closed, face outwards and have their volume, to 5 %', () => {
  for (const collider of COLLIDERS) {
    const shape = small_shape(collider, 0, { colliders: [] });
    assert.equal(open_edges(shape), 0, collider.kind);
    const ratio = volume(shape) / volume_of(collider);
    assert.ok(ratio > 0.95 && ratio < 1.001, `${collider.kind}: ${ratio}`);
  }
});

test('a turned box has its corners where its orientation puts them', () => {
  const half = Math.SQRT1_2; // a quarter turn about z: x becomes y
  const box = { kind: 'box', center: [1, 2, 3], half_extents: [0.3, 0.1, 0.2], orientation: [0, 0, half, half] };
  const { positions } = small_shape(box, 0, { colliders: [] });
  const reach = (axis) => Math.max(...positions.filter((_, i) => i % 3 === axis));
  assert.ok(Math.abs(reach(0) - 1.1) < 1e-6 && Math.abs(reach(1) - 2.3) < 1e-6 && Math.abs(reach(2) - 3.2) < 1e-6);
});

test('planes have no shape, and meshes their own', () => {
  const mesh = { collider: 4, positions: new Float32Array(9), triangles: Uint32Array.of(0, 1, 2) };
  assert.equal(small_shape({ kind: 'plane' }, 4, { colliders: [mesh] }), null);
  assert.equal(small_shape({ kind: 'mesh' }, 4, { colliders: [mesh] }), mesh);
});

/** Where a point is in the picture, from -1 to 1. */
function seen({ matrix }, [x, y, z]) {
  const [a, b, , w] = [0, 1, 2, 3].map((row) => matrix[row] * x + matrix[row + 4] * y + matrix[row + 8] * z + matrix[row + 12]);
  return { x: a / w, y: b / w, w };
}

const SQUARE = Float32Array.of(-0.5, 0, 0, 0.5, 0, 0, -0.5, 1, 0, 0.5, 1, 0);
const DIRECTIONS = [[0, 0.6, 0.8], [1, 0, 0], [0, 1, 0], [-0.6, 0, -0.8], [0, -1, 0]];

test('a small picture has the ball of the scene’s view in it, and fills its height with it', () => {
  for (const direction of DIRECTIONS) {
    const view = { target: [0, 0.5, 0], direction, radius: 0.8 };
    for (const aspect of [1.5, 0.6]) {
      const camera = small_camera(view, SQUARE, aspect);
      const { x, y } = seen(camera, view.target);
      assert.ok(Math.hypot(x, y) < 1e-5, 'its target is in the middle');
      let widest = 0;
      for (let k = 0; k < 400; k++) {
        const [polar, around] = [Math.acos(1 - (2 * k + 1) / 400), k * 2.4];
        const offset = [Math.sin(polar) * Math.cos(around), Math.cos(polar), Math.sin(polar) * Math.sin(around)];
        const at = seen(camera, view.target.map((value, axis) => value + view.radius * offset[axis]));
        assert.ok(at.w > 0 && Math.abs(at.x) < 1.001 && Math.abs(at.y) < 1.001, `${direction}: ${at.x}, ${at.y}`);
        widest = Math.max(widest, Math.abs(at.x), Math.abs(at.y));
      }
      assert.ok(widest > 0.95, `${direction}: only ${widest}`);
    }
  }
});

test('up is up in a small picture, and what is to the right is to the right', () => {
  const camera = small_camera({ target: [0, 0, 0], direction: [0, 0, 1], radius: 1 }, SQUARE, 1.5);
  assert.ok(seen(camera, [0, 0.5, 0]).y > 0.1);
  assert.ok(seen(camera, [0.5, 0, 0]).x > 0.1);
});

test('a cloth that has left the view is seen in its place, and so is one without a view', () => {
  const far = SQUARE.map((x, i) => (i % 3 === 1 ? x - 40 : x));
  const view = { target: [0, 0.5, 0], direction: [0, 0, 1], radius: 0.8 };
  for (const camera of [small_camera(view, far, 1.5), small_camera(undefined, far, 1.5)]) {
    const places = [0, 3, 6, 9].map((at) => seen(camera, far.slice(at, at + 3)));
    for (const { x, y } of places) assert.ok(Math.abs(x) < 1 && Math.abs(y) < 1);
    assert.ok(Math.max(...places.map(({ y }) => y)) > 0.5, 'it is not lost in the distance');
  }
});

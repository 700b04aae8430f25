import assert from 'node:assert/strict';
import test from 'node:test';
import { grid } from './support/grids.mjs';
import { numbers } from './support/made_up.mjs';
import { import_page_module } from './support/page_module.mjs';

// The drawn surface of folds: smooth where there is room for it, and never through another layer.

const { ClothMesh } = await import_page_module('view/cloth_mesh');
const { FreeSpace } = await import_page_module('view/free_space');
const { Objects } = await import_page_module('view/objects');

const [CELL, THICKNESS, SIDE] = [0.03, 0.004, 15];

/** A square of cloth about its middle, rolled about an axis that lies aslant in it by an angle [rad]. */
function folded(angle, curve) {
  const [along, across] = [Math.cos(angle), Math.sin(angle)];
  return grid(SIDE, (u, v) => {
    const [x, y] = [(u - 0.5) * CELL * (SIDE - 1), (v - 0.5) * CELL * (SIDE - 1)];
    const [out, up] = curve(y * along - x * across);
    return [out, x * along + y * across, up];
  });
}

/** A half circle between two parallel layers: how far out and up is the cloth at a way across the fold. */
const fold = (radius) => (way) => {
  const turn = Math.min(1, Math.max(-1, way / radius / (Math.PI / 2))) * (Math.PI / 2);
  const rest = Math.abs(way) - radius * (Math.PI / 2);
  return [radius * Math.cos(turn) - Math.max(0, rest), radius * Math.sin(turn)];
};

/** Layers one above the other, each joined to the next by a half circle. */
const pleats = (radius, length) => (way) => {
  const period = length + Math.PI * radius;
  const layer = Math.floor(way / period);
  const rest = way - layer * period;
  const turn = Math.max(0, rest - length) / radius;
  const out = Math.min(rest, length) - length / 2 + radius * Math.sin(turn);
  return [layer % 2 ? -out : out, layer * 2 * radius + radius * (1 - Math.cos(turn))];
};

/** An eight, which passes through itself in its middle. */
const eight = (way) => [0.1 * Math.sin(16 * way + 1.5), 0.05 * Math.sin(32 * way + 3)];

/** What the page draws of a cloth, without its hem. @param room, thickness as ClothMesh has them */
function drawn(mesh, room, thickness = THICKNESS) {
  const { positions, uv, triangles } = mesh;
  const flat = folded(0, (way) => [way, 0]).positions;
  const size = { vertices: positions.length / 3, triangles: triangles.length / 3 };
  const cloth = { first_vertex: 0, first_triangle: 0, ...size, thickness, look: {} };
  const data = { restPositions: flat, uv, triangles, colliders: [] };
  const cloths = new ClothMesh([{ ...cloth, rows: SIDE, columns: SIDE }], data, false, room);
  cloths.update(positions);
  const { geometry } = cloths.group.children[0];
  const points = geometry.attributes.position.array.slice();
  const indices = geometry.index.array.slice(0, triangles.length * 16);
  cloths.dispose();
  return { positions: points, triangles: indices };
}

/** Numbers from the lowest of some to the highest, in steps of 1. */
function range(values) {
  const [low, high] = [Math.floor(Math.min(...values)), Math.floor(Math.max(...values))];
  return Array.from({ length: high - low + 1 }, (_, k) => low + k);
}

/** How uneven the outermost line of a fold is, seen along its layers [m]. */
function unevenness({ positions, triangles }) {
  const [bins, half, fine] = [200, CELL * 2.5, 8];
  const outline = new Float64Array(bins).fill(-Infinity);
  for (let t = 0; t < triangles.length; t += 3) {
    const corners = [0, 1, 2].map((k) => positions.subarray(triangles[t + k] * 3, triangles[t + k] * 3 + 2));
    for (let i = 0; i <= fine; i++) {
      for (let j = 0; i + j <= fine; j++) {
        const weights = [i / fine, j / fine, 1 - (i + j) / fine];
        const [out, along] = [0, 1].map((axis) => corners.reduce((sum, each, k) => sum + weights[k] * each[axis], 0));
        const bin = Math.floor(((along + half) / (2 * half)) * bins);
        if (bin >= 0 && bin < bins) outline[bin] = Math.max(outline[bin], out);
      }
    }
  }
  return Math.max(...outline) - Math.min(...outline);
}

/** How many edges pass through triangles that they share no corner with. */
function crossings({ positions, triangles }) {
  const point = (k) => [positions[k * 3], positions[k * 3 + 1], positions[k * 3 + 2]];
  const minus = (a, b) => a.map((value, k) => value - b[k]);
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const volume = (a, b, c, d) => dot(minus(b, a), cross(minus(c, a), minus(d, a)));
  const buckets = new Map();
  const size = CELL / 4;
  const cells_of = (corners) => {
    const [xs, ys, zs] = [0, 1, 2].map((axis) => range(corners.map((corner) => corner[axis] / size)));
    return xs.flatMap((x) => ys.flatMap((y) => zs.map((z) => (x * 1000 + y) * 1000 + z)));
  };
  const edges = new Map();
  for (let t = 0; t < triangles.length; t += 3) {
    const corners = [...triangles.subarray(t, t + 3)];
    for (const cell of cells_of(corners.map(point))) {
      if (!buckets.has(cell)) buckets.set(cell, []);
      buckets.get(cell).push(corners);
    }
    for (const [a, b] of [[0, 1], [1, 2], [2, 0]].map((pair) => pair.map((k) => corners[k]).sort((p, q) => p - q))) {
      edges.set(`${a} ${b}`, [a, b]);
    }
  }
  let count = 0;
  for (const [a, b] of edges.values()) {
    const near = new Set(cells_of([point(a), point(b)]).flatMap((cell) => buckets.get(cell) ?? []));
    for (const corners of near) {
      if (corners.includes(a) || corners.includes(b)) continue;
      const [p, q, r, s, t] = [a, b, ...corners].map(point);
      const [before, behind] = [volume(p, r, s, t), volume(q, r, s, t)];
      if (before > 0 === behind > 0 || Math.min(Math.abs(before), Math.abs(behind)) < 2e-11) continue;
      const sides = [volume(p, q, r, s) > 0, volume(p, q, s, t) > 0, volume(p, q, t, r) > 0];
      if (sides[0] === sides[1] && sides[1] === sides[2]) count += 1;
    }
  }
  return count;
}

test('the outline of a fold aslant is far more even than that of its triangles, the rounder the fold', () => {
  for (const [radius, times] of [[0.5, 2], [0.7, 3], [1, 6]]) {
    for (const angle of [0.3, 0.7]) {
      const shape = folded(angle, fold(radius * CELL));
      const [coarse, fine] = [shape, drawn(shape)].map(unevenness);
      assert.ok(fine < coarse / times, `${fine} of ${coarse} m at a radius of ${radius} cells`);
    }
  }
});

test('layers of folds and pleats are not drawn through each other, however near they are', () => {
  assert.ok(crossings(folded(0.3, eight)) > 0, 'crossings are counted');
  for (const radius of [0.002, 0.004, 0.015]) {
    for (const angle of [0, 0.46, 0.7]) {
      for (const curve of [fold(radius), pleats(radius, 0.05)]) {
        const shape = folded(angle, curve);
        assert.equal(crossings(shape), 0);
        assert.equal(crossings(drawn(shape)), 0, `radius ${radius} m, angle ${angle}`);
      }
    }
  }
});

test('a fold bulges no farther towards an object than by half of what is free, and freely away from it', () => {
  const shape = folded(0.3, fold(0.5 * CELL));
  const bulging = (room) => drawn(shape, room, 0).positions;
  const [flat, free] = [() => 0, () => Infinity].map(bulging);
  const out = [...flat.keys()].filter((k) => k % 3 === 0); // the first coordinate of each vertex
  assert.ok(Math.max(...out.map((k) => free[k] - flat[k])) > 0.004);
  const outermost = Math.max(...out.map((k) => flat[k]));
  for (const gap of [0.001, 0.004]) {
    const place = outermost + gap;
    const to_wall = bulging(([x]) => place - x);
    for (const k of out) assert.ok(to_wall[k] - flat[k] < 0.5 * (place - flat[k]), `${to_wall[k]} m of ${place} m`);
  }
  assert.deepEqual(bulging(([x]) => x + 1), free, 'from a wall behind');
  assert.deepEqual(bulging(() => 1e-6), free, 'along a wall');
});

test('a picture of crumpled cloth looks at no more than a hundred triangles for each there is', () => {
  const { positions: rest, triangles } = folded(0, (way) => [way, 0]);
  const positions = rest.map((value) => value / 4); // all of it is within reach of each edge
  const space = new FreeSpace(positions, rest, triangles);
  const answers = () => {
    space.begin();
    let answered = 0;
    for (let t = 0; t < 3 * triangles.length; t += 3) {
      const corner = t % triangles.length;
      if (space.around(triangles[corner], triangles[corner + 1]) > 0) answered += 1;
    }
    return answered;
  };
  const [first, second] = [answers(), answers()];
  assert.ok(first > 50 && first <= 100, `${first}`);
  assert.equal(second, first, 'the next picture has as many');
});

test('the room around objects is the distance to balls, boxes and ground, and never more than to others', () => {
  const turned = [0, Math.sin(0.3), 0, Math.cos(0.3)];
  const shared = { name: 'it', pivot: [0, 0, 0] };
  const ball = { ...shared, kind: 'sphere', center: [1, 2, 0], radius: 0.3 };
  const box = { ...shared, kind: 'box', center: [0, 2, 0], half_extents: [0.1, 0.2, 0.4], orientation: turned };
  const capsule = { ...shared, kind: 'capsule', a: [-1, 2, 0], b: [-1.3, 2.4, 0.1], radius: 0.1 };
  const plane = { ...shared, kind: 'plane', point: [0, 0.5, 0], normal: [0, 1, 0] };
  const to_ball = (at) => Math.hypot(at[0] - 1, at[1] - 2, at[2]) - 0.3;
  const to_box = ([x, y, z]) => {
    const [c, s] = [Math.cos(-0.6), Math.sin(-0.6)];
    const own = [c * x + s * z, y - 2, c * z - s * x];
    return Math.hypot(...own.map((value, k) => Math.max(0, Math.abs(value) - box.half_extents[k])));
  };
  const to_capsule = (at) => {
    const way = capsule.b.map((value, k) => value - capsule.a[k]);
    const dot = (p, q) => p.reduce((sum, value, k) => sum + value * q[k], 0);
    const from = at.map((value, k) => value - capsule.a[k]);
    const along = Math.min(1, Math.max(0, dot(from, way) / dot(way, way)));
    return Math.hypot(...from.map((value, k) => value - along * way[k])) - 0.1;
  };
  const random = numbers(3);
  const data = { colliders: [] };
  const room_of = (collider) => new Objects([collider], data, 0);
  const [by_ball, by_box, by_capsule, by_ground] = [ball, box, capsule, plane].map(room_of);
  for (let k = 0; k < 300; k++) {
    const at = [random() * 3 - 1.5, random() * 3, random() * 2 - 1];
    const near = (one, other) => assert.ok(Math.abs(one - Math.max(0, other)) < 1e-6, `${one}, ${other} at ${at}`);
    near(by_ball.room(at), to_ball(at));
    near(by_box.room(at), to_box(at));
    near(by_ground.room(at), at[1] - 0.5);
    assert.ok(by_capsule.room(at) <= Math.max(0, to_capsule(at)) + 1e-6);
  }
  const moved = { collider: 0, position: [0, 0, 1], rotation: [0, 0, 0, 1] };
  by_ball.place([moved]);
  by_ground.place([{ ...moved, position: [0, 1, 0] }]);
  assert.ok(Math.abs(by_ball.room([1, 2, 2]) - 0.7) < 1e-6, 'where it is now');
  assert.ok(Math.abs(by_ground.room([0, 1.25, 0]) - 0.25) < 1e-6, 'where it is now');
});

import assert from 'node:assert/strict';
import test from 'node:test';
import { numbers } from './support/made_up.mjs';
import { import_page_module } from './support/page_module.mjs';

const { Fans } = await import_page_module('view/fans');
const { FabricCircle } = await import_page_module('view/fabric_circle');
const { apart, label_left } = await import_page_module('view/labels');
const { HandLatency } = await import_page_module('hold/hand_latency');
const { MarkDot, MarkLine, OrbitCamera } = await import_page_module('view/marks', 'view/camera');
const { cast_ray, point_on_triangle } = await import_page_module('view/ray');
const { creased_geometry } = await import_page_module('view/creased');
const { smooth_normals } = await import_page_module('view/normals');

test('a fan stays where the own hand put it until the server has answered', async () => {
  const fan = (x) => ({ position: [x, 1, 0], direction: [0, 0, 1] });
  const fans = new Fans();
  fans.receive([fan(0)]);
  const answers = [1, 2].map((x) => {
    fans.show([fan(x)]);
    let settle;
    fans.told(new Promise((resolve, reject) => (settle = { resolve, reject })));
    return settle;
  });
  assert.equal(fans.receive([fan(0)]), false, 'said before the server knew');
  answers[0].resolve();
  await null;
  assert.equal(fans.receive([fan(1)]), false, 'a place on the way');
  assert.deepEqual(fans.list, [fan(2)]);
  answers[1].reject(new Error('refused'));
  await null;
  assert.equal(fans.receive([fan(1)]), true, 'what it says after that counts');
  assert.deepEqual(fans.list, [fan(1)]);
});

test('the latency is that of movements while a hand holds in a running room, once each', () => {
  const meter = new HandLatency();
  meter.received(100, 0.02, 5);
  assert.equal(meter.shown(100, 5.01), null, 'nobody holds');
  meter.watch(true, 6);
  meter.received(101, 2.6, 6.1);
  assert.equal(meter.shown(101, 6.2), null, 'the movement was before the room went on');
  meter.received(101.1, 0.05, 6.3);
  meter.received(101.2, 0.05, 6.32);
  assert.equal(meter.shown(101, 6.31), null, 'its frame is not on the screen yet');
  const latency = meter.shown(101.1, 6.36);
  assert.ok(Math.abs(latency - 0.11) < 1e-9, `${latency}`);
  assert.equal(meter.shown(101.2, 6.4), null, 'the second frame shows no new movement');
  meter.received(101.3, 0.04, 6.5);
  meter.watch(false, 6.6);
  meter.watch(true, 6.7);
  assert.equal(meter.shown(101.3, 6.8), null, 'the hand let go meanwhile');
});

test('a label stays in the picture as long as its mark is there, beside and not upon it', () => {
  for (const picture of [390, 1280]) {
    for (let mark = 0; mark <= picture; mark += 5) {
      const left = label_left(mark, 110, picture);
      assert.ok(left >= 0 && left + 110 <= picture, `${left} beside ${mark}`);
      assert.ok(left > mark || left + 110 < mark, `${left} upon ${mark}`);
    }
    assert.ok(label_left(picture + 1, 110, picture) > picture, 'its mark is outside');
  }
});

/** Labels of hands that are so near each other, somewhere in a picture; the same for the same seed. */
function labels_of(count, near, { width, height }, seed) {
  const random = numbers(seed);
  const [x, y] = [random() * width, random() * height];
  return Array.from({ length: count }, () => {
    const label = { width: 40 + 130 * random(), height: 21 };
    const mark = Math.min(width, Math.max(0, x + near * (2 * random() - 1)));
    const at = Math.min(height - 12, Math.max(12, y + near * (2 * random() - 1)));
    return { ...label, x: label_left(mark, label.width, width), y: at, wanted: at };
  });
}

const cover = (a, b) =>
  a.x < b.x + b.width && b.x < a.x + a.width && Math.abs(a.y - b.y) < (a.height + b.height) / 2;

test('no label covers another, all of seven hands are there, in the picture and in their order', () => {
  const pictures = [{ width: 375, height: 667 }, { width: 667, height: 375 }, { width: 1280, height: 800 }];
  for (const picture of pictures)
    for (let seed = 1; seed <= 300; seed++) {
      const labels = labels_of(7, seed % 90, picture, seed);
      const placed = apart(labels, picture.height);
      assert.equal(placed.length, 7, `${seed}`);
      for (const [k, one] of placed.entries()) {
        assert.ok(one.y + one.height / 2 <= picture.height && one.y > -one.height, `${seed}: in the picture`);
        assert.ok(Math.abs(one.y - one.wanted) <= 160, `${seed}: near its mark`);
        for (const other of placed.slice(k + 1)) {
          assert.ok(!cover(one, other), `${seed}: ${JSON.stringify([one, other])}`);
          const meet = one.x < other.x + other.width && other.x < one.x + one.width;
          if (meet) assert.equal(one.y < other.y, one.wanted <= other.wanted, `${seed}: in their order`);
        }
      }
    }
});

test('a label that covers none stays beside its mark, and of a crowd at one point only the nearest are shown', () => {
  const picture = { width: 1280, height: 800 };
  const far = Array.from({ length: 20 }, (_, k) => ({ x: 100, y: 30 + 30 * k, width: 90, height: 21 }));
  const before = structuredClone(far);
  assert.deepEqual(apart(far, picture.height), before);
  const crowd = labels_of(60, 0, picture, 5);
  const placed = apart(crowd, picture.height);
  assert.ok(placed.length >= 7 && placed.length < 12, `${placed.length}`);
  for (const [k, one] of placed.entries()) for (const other of placed.slice(k + 1)) assert.ok(!cover(one, other));
});

test('a ray through a point of a triangle meets it there, from both sides', () => {
  const random = numbers(11);
  const positions = Float32Array.from({ length: 30 }, () => random() * 2 - 1);
  for (let trial = 0; trial < 500; trial++) {
    const first = Math.floor(random() * 8);
    const triangles = Uint32Array.of(first, first + 2, first + 1);
    const weights = [0.05 + random(), 0.05 + random(), 0.05 + random()];
    const sum = weights[0] + weights[1] + weights[2];
    const point = point_on_triangle(0, weights.map((w) => w / sum), positions, triangles);
    const origin = [random() * 4 - 2, random() * 4 - 2, random() * 4 - 2];
    const direction = point.map((value, axis) => value - origin[axis]);
    const hit = cast_ray(origin, direction, positions, triangles);
    assert.ok(hit, `trial ${trial}`);
    assert.ok(Math.abs(hit.distance - 1) < 1e-3, `distance ${hit.distance}`);
    const sum_of_weights = hit.barycentric.reduce((total, weight) => total + weight, 0);
    assert.ok(Math.abs(sum_of_weights - 1) < 1e-12);
    assert.ok(hit.barycentric.every((weight) => weight >= 0 && weight <= 1));
    const again = point_on_triangle(0, hit.barycentric, positions, triangles);
    for (let axis = 0; axis < 3; axis++) {
      assert.ok(Math.abs(again[axis] - hit.position[axis]) < 1e-4);
    }
    assert.equal(cast_ray(origin, direction.map((value) => -value), positions, triangles), null);
  }
});

test('normals of a plane grid are those of the plane, whatever the sizes of its triangles', () => {
  const positions = Float32Array.of(0, 0, 0, 2, 0, 2, 0, 1, 0, 3, 5, 3);
  const normals = new Float32Array(12);
  smooth_normals(positions, Uint32Array.of(0, 1, 2, 1, 3, 2), normals);
  for (let i = 0; i < 12; i += 3) {
    assert.ok(Math.abs(normals[i] + Math.SQRT1_2) < 1e-6);
    assert.ok(Math.abs(normals[i + 1]) < 1e-6);
    assert.ok(Math.abs(normals[i + 2] - Math.SQRT1_2) < 1e-6);
  }
});

/** A grid of cloth in the plane of x and y, with one diagonal or the other. */
function grid(columns, rows, cell) {
  const positions = new Float32Array(columns * rows * 3);
  for (let k = 0; k < columns * rows; k++)
    positions.set([(k % columns) * cell, Math.floor(k / columns) * cell, 0], k * 3);
  const triangles = [];
  for (let row = 0; row + 1 < rows; row++)
    for (let column = 0; column + 1 < columns; column++) {
      const [a, b] = [row * columns + column, row * columns + column + 1];
      const [c, d] = [a + columns, b + columns];
      triangles.push(...((row + column) % 2 ? [a, b, c, b, d, c] : [a, b, d, a, d, c]));
    }
  return { positions, triangles: Uint32Array.from(triangles) };
}

test('marks are drawn fainter where something is in front of them, and nowhere twice', () => {
  const GREATER = 6; // of three's depth functions
  for (const mark of [new MarkLine(2, 0.9, 20), new MarkDot(5, 21)]) {
    const opacities = new Map();
    mark.group.traverse(({ material, renderOrder }) => {
      if (!material) return;
      assert.ok(material.depthTest && !material.depthWrite && material.transparent);
      const side = material.depthFunc === GREATER ? 'hidden' : 'seen';
      opacities.set(`${side} ${renderOrder}`, material.opacity);
    });
    const seen = [...opacities].filter(([name]) => name.startsWith('seen'));
    assert.ok(seen.length > 0 && opacities.size === 2 * seen.length);
    for (const [name, opacity] of seen) {
      const hidden = opacities.get(name.replace('seen', 'hidden'));
      assert.ok(hidden > 0.1 && hidden < 0.5 * opacity);
    }
  }
});

test('a dot lies before the place that it marks, by its radius, seen from anywhere', () => {
  const orbit = new OrbitCamera();
  orbit.resize(600, 400);
  const dot = new MarkDot(5, 21);
  for (const turn of [0, 1, 2]) {
    orbit.orbit(turn, 0.2);
    orbit.update(9);
    const { camera } = orbit;
    const place = [0.1, 1, -0.2];
    dot.set(place, camera, 400);
    const eye = camera.position;
    const distance = (point) => Math.hypot(eye.x - point.x, eye.y - point.y, eye.z - point.z);
    const [x, y, z] = place;
    const before = distance({ x, y, z }) - distance(dot.group.position);
    assert.ok(Math.abs(before / dot.group.scale.x - 1) < 1e-6, `${before}`);
  }
});

test('a circle in the fabric has its radius from any point, and goes with the cloth', () => {
  const { positions, triangles } = grid(21, 31, 0.05);
  const circle = new FabricCircle(positions, triangles);
  const lifted = positions.map((value, k) => (k % 3 === 2 ? value + 2 : value));
  const random = numbers(3);
  for (let trial = 0; trial < 200; trial++) {
    const u = random();
    const v = random() * (1 - u);
    const barycentric = [1 - u - v, u, v];
    const triangle = 400 + Math.floor(random() * 300);
    const centre = point_on_triangle(triangle, barycentric, positions, triangles);
    const radius = 0.01 + 0.19 * random();
    const line = circle.around({ triangle, barycentric }, radius, lifted);
    assert.deepEqual(line[0], line.at(-1), 'it is closed');
    for (const [x, y, z] of line) {
      const inside = x > 1e-6 && x < 1 - 1e-6;
      const distance = Math.hypot(x - centre[0], y - centre[1]);
      assert.ok(Math.abs(z - 2) < 1e-5);
      assert.ok(distance < radius + 1e-5);
      if (inside) assert.ok(Math.abs(distance - radius) < 1e-5, `${distance} for ${radius}`);
    }
  }
});

test('a circle at the edge of the cloth follows the edge', () => {
  const { positions, triangles } = grid(11, 11, 0.1);
  const circle = new FabricCircle(positions, triangles);
  const line = circle.around({ triangle: 0, barycentric: [1, 0, 0] }, 0.25, positions);
  for (const [x, y] of line) {
    assert.ok(x > -1e-6 && y > -1e-6 && Math.hypot(x, y) < 0.25 + 1e-6);
    const on_edge = Math.min(x, y) < 1e-6;
    assert.ok(on_edge || Math.abs(Math.hypot(x, y) - 0.25) < 1e-6);
  }
});

/** Cosine of the largest angle between normals that a geometry has at one place. */
function least_agreement(geometry) {
  const [points, normals] = [geometry.getAttribute('position'), geometry.getAttribute('normal')];
  let least = 1;
  const at = (attribute, k) => [attribute.getX(k), attribute.getY(k), attribute.getZ(k)];
  for (let i = 0; i < points.count; i++) {
    for (let k = 0; k < i; k++) {
      if (Math.hypot(...at(points, i).map((value, axis) => value - at(points, k)[axis])) > 1e-6) continue;
      const dot = at(normals, i).reduce((sum, value, axis) => sum + value * at(normals, k)[axis], 0);
      least = Math.min(least, dot);
    }
  }
  return least;
}

test('a steep bump of small angles has no seam, and a sharp edge stays one', () => {
  const sides = 12; // of a cone: next to each other at 26 degrees, opposite ones at 120
  const points = [0, 0, 1];
  for (let k = 0; k < sides; k++) {
    const angle = (2 * Math.PI * k) / sides;
    points.push(Math.cos(angle) / Math.sqrt(3), Math.sin(angle) / Math.sqrt(3), 0);
  }
  const cone = Array.from({ length: sides }, (_, k) => [0, 1 + k, 1 + ((k + 1) % sides)]).flat();
  const bump = creased_geometry(Float32Array.from(points), Uint32Array.from(cone));
  assert.ok(least_agreement(bump) > 1 - 1e-6);
  const bottom = Array.from({ length: sides - 2 }, (_, k) => [1, 3 + k, 2 + k]).flat();
  const solid = creased_geometry(Float32Array.from(points), Uint32Array.from([...cone, ...bottom]));
  assert.ok(least_agreement(solid) < Math.cos((50 * Math.PI) / 180), 'its rim');
});

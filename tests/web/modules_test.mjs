import assert from 'node:assert/strict';
import test from 'node:test';
import { numbers } from './support/made_up.mjs';
import { import_page_module } from './support/page_module.mjs';

const { Fans } = await import_page_module('view/fans');
const { HandLatency } = await import_page_module('hold/hand_latency');
const { cast_ray, point_on_triangle } = await import_page_module('view/ray');
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

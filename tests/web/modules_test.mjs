import assert from 'node:assert/strict';
import test from 'node:test';
import { import_page_module } from './support/page_module.mjs';

const { Fans } = await import_page_module('view/fans');
const { Playback } = await import_page_module('wire/playback');
const { cast_ray, point_on_triangle } = await import_page_module('view/ray');
const { smooth_normals } = await import_page_module('view/normals');

const PERIOD = 1 / 60;

/** A frame of one vertex that moves along x with 1 m/s of the server's time. */
function frame_at(tick, changes = {}) {
  const serverTime = 100 + tick * PERIOD;
  const positions = Float32Array.of(serverTime - 100, 0, 0);
  const state = { grabs: [], poses: [], jump: false, paused: false };
  return { tick, serverTime, positions, ...state, ...changes };
}

/** Numbers in [0, 1) that are the same each time (Park and Miller). */
function numbers(seed) {
  let state = seed;
  return () => (state = (state * 48271) % 2147483647) / 2147483647;
}

test('who watches sees uniform motion although frames come unevenly', () => {
  const playback = new Playback(1);
  const random = numbers(7);
  const arrivals = Array.from({ length: 600 }, (_, tick) => ({
    at: tick * PERIOD + random() * 0.02,
    frame: frame_at(tick),
  }));
  const shown = [];
  for (let now = 0; now < 9.9; now += 1 / 144) {
    while (arrivals.length && arrivals[0].at <= now) playback.push(arrivals.shift().frame, now);
    playback.sample(now, false);
    if (now > 4) shown.push(playback.positions[0]);
  }
  const steps = shown.slice(1).map((x, i) => x - shown[i]);
  for (const step of steps) assert.ok(Math.abs(step * 144 - 1) < 0.16, `speed ${step * 144}`);
});

test('the picture never goes back, also when a hand lets go', () => {
  const playback = new Playback(1);
  let last = -1;
  for (let tick = 0; tick < 120; tick++) {
    const now = tick * PERIOD;
    playback.push(frame_at(tick), now);
    for (const later of [0, 0.006, 0.012]) {
      playback.sample(now + later, tick > 40 && tick < 80);
      assert.ok(playback.positions[0] >= last);
      last = playback.positions[0];
    }
  }
});

test('who holds sees the newest frame at once, who watches one of the past', () => {
  const [holder, watcher] = [new Playback(1), new Playback(1)];
  for (let tick = 0; tick < 60; tick++) {
    holder.push(frame_at(tick), tick * PERIOD);
    watcher.push(frame_at(tick), tick * PERIOD);
    holder.sample(tick * PERIOD, true);
    watcher.sample(tick * PERIOD, false);
  }
  assert.equal(holder.tick, 59);
  const behind = holder.positions[0] - watcher.positions[0];
  assert.ok(behind > 0 && behind < 3 * PERIOD, `${behind} s behind`);
});

test('nothing is shown beyond the last frame, and nothing moves when frames stop', () => {
  const playback = new Playback(1);
  for (let tick = 0; tick < 10; tick++) playback.push(frame_at(tick), tick * PERIOD);
  for (let now = 0; now < 3; now += 0.01) playback.sample(now, false);
  assert.equal(playback.positions[0], Math.fround(9 * PERIOD + 100 - 100));
  assert.equal(playback.sample(4, false), false);
});

test('a paused frame is shown as it is, at once', () => {
  const playback = new Playback(1);
  for (let tick = 0; tick < 9; tick++) playback.push(frame_at(tick), tick * PERIOD);
  playback.sample(8 * PERIOD, false);
  playback.push(frame_at(9, { paused: true }), 9 * PERIOD);
  assert.equal(playback.sample(9 * PERIOD, false), true);
  assert.equal(playback.tick, 9);
  assert.equal(playback.sample(10, false), false);
});

test('a jump is not interpolated to', () => {
  const playback = new Playback(1);
  for (let tick = 0; tick < 9; tick++) {
    playback.push(frame_at(tick), tick * PERIOD);
    playback.sample(tick * PERIOD, false);
  }
  const reset = frame_at(9, { tick: 0, positions: Float32Array.of(-5, 0, 0), jump: true });
  playback.push(reset, 9 * PERIOD);
  playback.sample(9 * PERIOD, false);
  assert.deepEqual([...playback.positions], [-5, 0, 0]);
  assert.equal(playback.tick, 0);
});

test('an object goes with the cloth and turns the shorter way, whichever sign its turns have', () => {
  const playback = new Playback(1);
  const turned = (angle, sign) => [0, sign * Math.sin(angle / 2), 0, sign * Math.cos(angle / 2)];
  for (let tick = 0; tick < 40; tick++) {
    const frame = frame_at(tick);
    const position = [0, frame.serverTime - 100, 0];
    const rotation = turned(2 * (frame.serverTime - 100), tick % 2 ? -1 : 1);
    playback.push({ ...frame, poses: [{ collider: 3, position, rotation }] }, tick * PERIOD);
    for (const later of [0, 0.005, 0.011]) {
      playback.sample(tick * PERIOD + later, false);
      const [pose] = playback.poses;
      const time = playback.positions[0];
      assert.equal(pose.collider, 3);
      assert.ok(Math.abs(pose.position[1] - time) < 1e-5);
      const along = turned(2 * time, 1).reduce((sum, v, i) => sum + v * pose.rotation[i], 0);
      assert.ok(Math.abs(Math.abs(along) - 1) < 1e-6, `${pose.rotation} at ${time}`);
      assert.ok(Math.abs(Math.hypot(...pose.rotation) - 1) < 1e-6);
    }
  }
  assert.ok(playback.positions[0] % PERIOD > 1e-4); // between frames
});

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

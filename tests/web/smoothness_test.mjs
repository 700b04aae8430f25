import assert from 'node:assert/strict';
import test from 'node:test';
import { frame_at, numbers } from './support/made_up.mjs';
import { import_page_module } from './support/page_module.mjs';

// What is shown when, on frames that arrive as a test makes up.

const { Playback } = await import_page_module('wire/playback');

const PERIOD = 1 / 60;

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

/** Frames of a room and when they arrive, over a connection that keeps their order [s]. */
function arrivals({ rate = 60, jitter = 0, seconds = 24, seed = 5 }) {
  const random = numbers(seed);
  let last = 0;
  return Array.from({ length: seconds * rate }, (_, tick) => {
    last = Math.max(last, tick / rate + 0.003 - jitter * Math.log(1 - random()));
    return { at: last, frame: frame_at(tick, {}, rate) };
  });
}

/**
 * What a display draws of these frames.
 * @param {(now: number) => boolean} holds whether the viewer holds the cloth then
 * @returns {{now: number, shown: number, newest: number}[]} server's time that each draw shows, and
 *   that of the newest frame [s]
 */
function draws({ hz = 60, holds = () => true, ...arriving }) {
  const playback = new Playback(1);
  const coming = arrivals(arriving);
  const end = coming.at(-1).at;
  const drawn = [];
  let newest = NaN;
  for (let now = 0.0007; now < end; now += 1 / hz) {
    for (; coming.length && coming[0].at <= now; coming.shift()) {
      playback.push(coming[0].frame, now);
      newest = coming[0].frame.positions[0];
    }
    playback.sample(now, holds(now));
    drawn.push({ now, shown: playback.positions[0], newest });
  }
  return drawn;
}

const speeds = (drawn, hz) => drawn.slice(1).map(({ shown }, k) => (shown - drawn[k].shown) * hz);
const mean = (numbers) => numbers.reduce((sum, number) => sum + number, 0) / numbers.length;

// A tenth of the natural speed counts as frozen too.
const PLACES = [
  { what: 'a LAN', most: 0.015 },
  { what: '8 ms of jitter', jitter: 0.008, most: 0.015 },
  { what: 'a display of 144 Hz', hz: 144, most: 0.015 },
  { what: 'a display that drifts against the ticks', hz: 59.7, most: 0.015 },
  { what: 'a room at 20 ticks/s', rate: 20, most: 0.05 },
  { what: 'a room at 20 ticks/s on a display of 144 Hz', rate: 20, hz: 144, most: 0.05 },
  { what: 'a room at 20 ticks/s with 8 ms of jitter', rate: 20, hz: 144, jitter: 0.008, most: 0.05 },
  { what: '8 ms of jitter on a display of 144 Hz', hz: 144, jitter: 0.008, most: 0.025 },
];

for (const { what, most, hz = 60, ...arriving } of PLACES) {
  test(`who holds over ${what} sees 2 % frozen draws at most, ${most * 1000} ms behind the newest`, () => {
    for (const seed of [5, 77, 1234]) {
      const drawn = draws({ hz, seed, ...arriving }).filter(({ now }) => now > 4);
      const frozen = speeds(drawn, hz).filter((speed) => speed < 0.1).length / drawn.length;
      assert.ok(frozen <= 0.02, `${(frozen * 100).toFixed(1)} % frozen`);
      const behind = mean(drawn.map(({ shown, newest }) => newest - shown));
      assert.ok(behind <= most, `${(behind * 1000).toFixed(1)} ms behind`);
    }
  });
}

test('nothing jumps when a hand takes hold or lets go, and the picture never goes back', () => {
  for (const { hz = 60, ...arriving } of PLACES) {
    const holds = (now) => Math.floor(now / 3) % 2 === 1;
    const drawn = draws({ hz, holds, ...arriving }).filter(({ now }) => now > 2);
    const natural = speeds(drawn, hz);
    for (const [k, speed] of natural.entries()) {
      const hurries = drawn[k + 1].now % 6 > 3 && drawn[k + 1].now % 6 < 3.5; // it has just taken hold
      assert.ok(speed >= 0 && speed < (hurries ? 2.01 : 1.26), `${speed} of the natural speed`);
    }
  }
});

test('a tenth of a second after taking hold the picture is less than half as far behind as before', () => {
  for (const jitter of [0.008, 0.02]) {
    const taken = 6; // when the hand takes hold [s]
    const before = [];
    const after = [];
    for (let seed = 1; seed <= 12; seed++) {
      for (const { now, shown, newest } of draws({ jitter, seed: 37 * seed, seconds: 8, holds: (now) => now > taken })) {
        if (now > taken - 0.2 && now < taken) before.push(newest - shown);
        if (now > taken + 0.05 && now < taken + 0.15) after.push(newest - shown);
      }
    }
    assert.ok(mean(after) < 0.45 * mean(before), `${mean(after)} s behind, ${mean(before)} before`);
  }
});

test('a hand is shown in the first picture after the frame that tells of it, and never goes back', () => {
  for (const holds of [false, true]) {
    const playback = new Playback(1);
    const random = numbers(11);
    let last = 30; // where the hand begins
    for (let tick = 0; tick < 60; tick++) {
      const hand = { id: 7, viewer: 2, held: [0, 0, 0], target: [tick, 0, 0], force: 3 };
      const grabs = tick < 30 ? [] : [hand];
      playback.push(frame_at(tick, { grabs }), (tick + random()) * PERIOD);
      for (const later of [1, 1.3, 1.7]) {
        playback.sample((tick + later) * PERIOD, holds && tick >= 30);
        assert.equal(playback.grabs.length, grabs.length, `tick ${tick}`);
        if (!grabs.length) continue;
        const [x] = playback.grabs[0].target;
        assert.ok(x >= last, `${x} after ${last}`);
        last = x;
      }
    }
    assert.ok(last > 50, 'it moves');
  }
});

test('who holds in a room that halts is shown its last frame, and then nothing moves', () => {
  const playback = new Playback(1);
  for (let tick = 0; tick < 60; tick++) playback.push(frame_at(tick), tick * PERIOD);
  for (let now = 59 * PERIOD; now < 62 * PERIOD; now += 0.004) {
    playback.sample(now, true);
    assert.ok(playback.positions[0] <= Math.fround(59 * PERIOD));
  }
  for (let now = 1.1; now < 2; now += 0.004) playback.sample(now, true);
  assert.equal(playback.positions[0], Math.fround(frame_at(59).serverTime - 100));
  assert.equal(playback.sample(3, true), false);
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

test('a frame of a moment that is shown already is shown too: hands move in a room that stands', () => {
  const playback = new Playback(1);
  const hand = (x) => ({ id: 1, viewer: 2, held: [0, 0, 0], target: [x, 0, 0], force: 0 });
  for (let tick = 0; tick < 9; tick++) playback.push(frame_at(tick), tick * PERIOD);
  for (const x of [1, 2]) {
    playback.push(frame_at(9, { paused: true, grabs: [hand(x)] }), 1 + x);
    assert.equal(playback.sample(1 + x, false), true);
    assert.deepEqual(playback.grabs, [hand(x)]);
    assert.equal(playback.sample(1.5 + x, false), false);
  }
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

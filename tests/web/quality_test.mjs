import assert from 'node:assert/strict';
import test from 'node:test';
import { import_page_module } from './support/page_module.mjs';

// How finely the page draws, on made-up times of pictures.

const { Quality } = await import_page_module('view/quality');
const { sample_of } = await import_page_module('view/samples');
const { PictureClock } = await import_page_module('view/picture_clock');
const { Rest } = await import_page_module('view/rest');

const DISPLAY = 1 / 60; // [s]

/**
 * Draws for a time on a machine whose pictures take so long, at a display that shows them.
 * @param {(pixel_ratio: number) => number} cost [s]
 * @returns pixel ratio after each picture, with its time [s]
 */
function draw(quality, seconds, cost, display = DISPLAY) {
  const drawn = [];
  for (let time = 0; time < seconds; ) {
    const interval = Math.max(display, cost(quality.pixel_ratio));
    time += interval;
    quality.judge(interval);
    drawn.push({ time, ratio: quality.pixel_ratio });
  }
  return drawn;
}

/** A machine that needs a time for each picture and one for each pixel [s, at one pixel a unit]. */
const machine = (fixed, per_pixel) => (ratio) => fixed + per_pixel * ratio * ratio;

const changes = (drawn) =>
  drawn.filter(({ ratio }, i) => i > 0 && ratio !== drawn[i - 1].ratio).length;

test('after slowness ends the picture is at its finest within four seconds', () => {
  for (const density of [1, 1.5, 2, 3]) {
    for (const seconds of [0.3, 5, 120]) {
      for (const slow of [machine(0.3, 0), machine(0.02, 0.08), machine(0, 0.06)]) {
        const quality = new Quality(() => density);
        const finest = quality.pixel_ratio;
        draw(quality, seconds, slow);
        const after = draw(quality, 4, machine(0.002, 0.001));
        assert.equal(after.at(-1).ratio, finest, `density ${density}, ${seconds} s of ${slow}`);
      }
    }
  }
});

test('a machine that cannot keep up gets coarser pictures within a second', () => {
  const quality = new Quality(() => 2);
  const drawn = draw(quality, 3, machine(0.005, 0.03));
  const last = drawn.at(-1).ratio;
  assert.ok(last < 2, `${last}`);
  assert.ok(0.005 + 0.03 * last * last <= 0.045, 'it is quick enough');
});

test('a machine that is far too slow gets the coarsest picture after three, but not after a hitch', () => {
  const quality = new Quality(() => 2);
  quality.judge(0.5);
  quality.judge(0.5);
  assert.equal(quality.pixel_ratio, 2, 'two slow pictures may be a hitch');
  quality.judge(DISPLAY);
  const drawn = draw(quality, 5, machine(0.05, 0.25));
  assert.equal(drawn[2].ratio, 0.5, `${drawn.map(({ ratio }) => ratio)}`);
  assert.equal(changes(drawn), 1, 'it goes there in one step');
});

test('pictures are judged by all the time they take, of which the camera goes on by a tenth of a second', () => {
  const clock = new PictureClock();
  const start = performance.now() / 1000;
  for (const k of [1, 2, 3]) {
    const elapsed = clock.step(start + 0.5 * k);
    const { interval } = clock.judge(true, true);
    assert.ok(elapsed <= 0.1, `${elapsed}`);
    if (k > 1) assert.ok(Math.abs(interval - 0.5) < 1e-9, `${interval}`);
  }
});

test('the picture does not waver, whatever a machine needs for it', () => {
  let most = 0;
  for (const fixed of [0, 0.004, 0.01, 0.02, 0.03, 0.04, 0.044]) {
    for (const per_pixel of [0.002, 0.008, 0.015, 0.023, 0.031, 0.05, 0.09]) {
      const quality = new Quality(() => 2);
      const cost = machine(fixed, per_pixel);
      draw(quality, 20, cost);
      most = Math.max(most, changes(draw(quality, 120, cost)));
    }
  }
  assert.ok(most <= 8, `${most} changes in two minutes`);
});

test('a machine whose fine pictures are suddenly slow is asked ever more seldom', () => {
  const quality = new Quality(() => 1);
  const cliff = (ratio) => (ratio > 0.8 ? 0.08 : 0.01);
  draw(quality, 60, cliff);
  const drawn = draw(quality, 120, cliff);
  assert.ok(changes(drawn) <= 8, `${changes(drawn)} changes`);
});

test('a display of 30 pictures a second gets the finest one too', () => {
  const quality = new Quality(() => 2);
  draw(quality, 5, machine(0.2, 0), 1 / 30);
  const drawn = draw(quality, 60, machine(0.002, 0.001), 1 / 30);
  assert.equal(drawn.at(-1).ratio, 2);
  assert.equal(changes(drawn.filter(({ time }) => time > 40)), 0);
});

/** Pictures of a room of so many ticks a second, each shown for a quarter of a second. */
function begun_rests(rest, ticks, seconds) {
  let begun = 0;
  let resting = false;
  for (let now = 0; now < seconds; now += DISPLAY) {
    const changed = (now * ticks) % 1 < 0.25 * ticks;
    const rests = rest.update(now, changed, true);
    if (rests && !resting) begun += 1;
    resting = rests;
  }
  return begun;
}

test('a room of slow ticks does not change the canvas at each of them', () => {
  for (const ticks of [0.3, 0.5, 1, 1.5, 1.9]) {
    const begun = begun_rests(new Rest(), ticks, 60);
    // The canvas changes its size when a rest begins and when it ends.
    assert.ok(2 * begun <= (ticks >= 1.5 ? 2 : 6), `${ticks} ticks a second: ${begun}`);
  }
});

test('a picture that changes no more rests within half a second, also after a slow room', () => {
  const rest = new Rest();
  rest.update(0, true, true);
  assert.equal(rest.update(0.3, false, false), false);
  assert.equal(rest.update(0.5, false, false), true);
  begun_rests(rest, 1, 30);
  rest.update(31, true, true);
  rest.update(42, false, false);
  rest.update(50, true, true);
  assert.equal(rest.update(50.5, false, false), true);
});

test('a viewer who turns the view of a resting cloth does not put off its fine picture', () => {
  const rest = new Rest();
  for (let now = 0; now < 20; now += 2) {
    rest.update(now, true, false);
    assert.equal(rest.update(now + 0.5, false, false), true);
  }
});

test('the exposures of a picture at rest are taken evenly over the pixel and the lights', () => {
  for (const count of [8, 24]) {
    const samples = Array.from({ length: count }, (_, k) => sample_of(k));
    for (const [name, reach] of [['pixel', 0.5], ['key', 1], ['sky', 1]]) {
      for (const axis of [0, 1]) {
        const values = samples.map((sample) => sample[name][axis]);
        const mean = values.reduce((sum, value) => sum + value, 0) / count;
        assert.ok(Math.abs(mean) < 0.2 * reach, `${name}: a mean of ${mean}`);
        assert.ok(values.every((value) => Math.abs(value) <= reach));
        assert.ok(Math.max(...values) > 0.35 * reach && Math.min(...values) < -0.35 * reach);
      }
    }
  }
});

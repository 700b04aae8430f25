import assert from 'node:assert/strict';
import test from 'node:test';
import { camera_at_rest, done, pixel_of, project, read, until } from './support/browser.mjs';
import { with_page, with_server } from './support/default_page.mjs';
import {
  COLUMNS,
  bounded,
  particle_pixel,
  position,
  pulling,
  shows_last_tick,
} from './support/default_scene.mjs';
import { end_long_presses, fingers_on, hold_long_presses, long_presses } from './support/touch.mjs';

// Hands by touch: each finger on the cloth is one, and fingers beside it help or move the camera.

const PHONE = { width: 400, height: 720, touch: true };
const PARTICLE = 4 * COLUMNS + 14;

/** The camera when it rests elsewhere than it did. */
const camera_after = (page, before) =>
  until(async () => {
    const camera = await camera_at_rest(page);
    return JSON.stringify(camera) !== JSON.stringify(before) && camera;
  }, 'the camera goes elsewhere');

/** The server's hands once it has done all that the page has asked for. */
async function hands_now(page, script) {
  await done(page);
  return script.query('grabs');
}

/** Two pixels of the view just below the cloth, or above it where a panel is below. */
async function beside(page) {
  const { positions, camera, size } = await page.evaluate(() => {
    const { positions, camera, size } = window.weft;
    return { positions, camera, size };
  });
  const heights = [];
  for (let k = 0; k < positions.length; k += 3)
    heights.push(project(camera, size, positions.slice(k, k + 3)).y);
  const under = ({ x, y }) => page.evaluate(([a, b]) => document.elementFromPoint(a, b)?.id, [x, y]);
  const [top, bottom] = [Math.min(...heights), Math.max(...heights)];
  for (const height of [bottom + 20, top - 30, bottom + 8, top - 8]) {
    const places = [120, 280].map((x) => ({ x, y: Math.round(height) }));
    const ids = await Promise.all(places.map(under));
    if (ids.every((id) => id === 'view')) return places;
  }
  return assert.fail('the cloth and the panels leave no place free');
}

/** A phone at the default scene's start, where time stands still but where the test lets it pass. */
const with_phone = (act) =>
  with_page({ ...PHONE, paused: true }, async (page, script) => {
    await shows_last_tick(page, script);
    await hold_long_presses(page);
    await camera_at_rest(page);
    await act({ page, script, fingers: await fingers_on(page) });
  });

test('one finger lifts the cloth, and beside it turns the view', bounded, () =>
  with_phone(async ({ page, script, fingers }) => {
    const home = await camera_at_rest(page);
    const height = (await position(script, PARTICLE))[1];
    await fingers.press(0, await particle_pixel(page, PARTICLE));
    await until(() => script.last.grabs.length === 1, 'one finger holds the cloth');
    assert.equal(await long_presses(page), 1);
    await fingers.move({ 0: [0, -90] });
    await until(async () => (await long_presses(page)) === 0, 'a finger that moves does not press');
    await until(async () => {
      await script.advance(5);
      return (await position(script, PARTICLE))[1] > height + 0.1;
    }, 'it is lifted');
    await fingers.lift(0);
    await until(() => script.last.grabs.length === 0);
    await shows_last_tick(page, script);
    assert.deepEqual(await camera_at_rest(page), home);

    const [below] = await beside(page);
    await fingers.press(0, below);
    await fingers.move({ 0: [80, 0] });
    assert.deepEqual(await hands_now(page, script), []);
    await fingers.lift(0);
    await camera_after(page, home);
  }),
);

test('two fingers on the cloth are two hands, and each lets go by itself', bounded, () =>
  with_phone(async ({ page, script, fingers }) => {
    const home = await camera_at_rest(page);
    const second = 4 * COLUMNS + 22;
    const targets = async () =>
      new Map((await script.query('grabs')).map(({ id, target }) => [id, target]));
    await fingers.press(0, await particle_pixel(page, PARTICLE));
    await until(() => script.last.grabs.length === 1);
    await fingers.press(1, await particle_pixel(page, second));
    await until(() => script.last.grabs.length === 2, 'the second finger is a second hand');
    await until(async () => (await read(page, 'hands')).length === 2, 'both are drawn');
    const before = await targets();
    await fingers.move({ 0: [0, -60] });
    const [first_id, second_id] = [...before.keys()];
    await until(async () => (await targets()).get(first_id)[1] > before.get(first_id)[1] + 0.05);
    assert.deepEqual((await targets()).get(second_id), before.get(second_id), 'the other rests');
    await fingers.lift(0);
    await until(() => script.last.grabs.length === 1, 'the first lets go');
    assert.equal(script.last.grabs[0].id, second_id);
    await fingers.move({ 1: [30, 0] });
    await until(async () => (await targets()).get(second_id)[0] !== before.get(second_id)[0]);
    await fingers.lift(1);
    await until(() => script.last.grabs.length === 0);
    assert.deepEqual(await camera_at_rest(page), home);
  }),
);

test('a finger beside the cloth pushes what another holds away, and draws it near', bounded, () =>
  with_phone(async ({ page, script, fingers }) => {
    const home = await camera_at_rest(page);
    const distance = async () => {
      const [{ target }] = await script.query('grabs');
      return Math.hypot(...target.map((value, axis) => value - home.position[axis]));
    };
    await fingers.press(0, await particle_pixel(page, PARTICLE));
    await pulling(page, script);
    const first = await distance();
    const [below] = await beside(page);
    await fingers.press(1, below);
    await fingers.move({ 1: [0, -100] });
    await until(async () => (await distance()) > first * 1.1, 'up: away');
    await fingers.move({ 1: [0, 200] });
    await until(async () => (await distance()) < first * 0.9, 'down: near');
    assert.equal((await hands_now(page, script)).length, 1);
    await fingers.lift(0);
    await until(() => script.last.grabs.length === 0);
    await fingers.move({ 1: [60, 0] });
    assert.deepEqual(await hands_now(page, script), []);
    await fingers.lift(1);
    assert.deepEqual(await camera_at_rest(page), home, 'the view stays where it was');
  }),
);

test('two fingers beside the cloth shift and zoom', bounded, () =>
  with_phone(async ({ page, script, fingers }) => {
    const home = await camera_at_rest(page);
    const [left, right] = await beside(page);
    await fingers.press(0, left);
    await fingers.press(1, right);
    await fingers.move({ 0: [-40, 0], 1: [40, 0] });
    assert.deepEqual(await hands_now(page, script), []);
    await fingers.lift(1);
    await fingers.lift(0);
    const zoomed = await camera_after(page, home);
    const distance = ({ position: [x, , z] }) => Math.hypot(x, z);
    assert.ok(distance(zoomed) < distance(home) * 0.98, `${distance(zoomed)}, ${distance(home)}`);
  }),
);

test('a long press pins the cloth and lets go', bounded, () =>
  with_phone(async ({ page, script, fingers }) => {
    const pins = async () => (await script.query('pins')).length;
    const before = await pins();
    await fingers.press(0, await particle_pixel(page, PARTICLE));
    await until(async () => (await long_presses(page)) === 1, 'a finger rests on the cloth');
    assert.equal((await hands_now(page, script)).length, 1, 'and holds it');
    assert.equal(await pins(), before);
    await end_long_presses(page);
    await until(async () => (await pins()) === before + 1, 'a long press pins');
    await until(() => script.last.grabs.length === 0, 'and lets go');
    await fingers.lift(0);
  }),
);

test('a long press frees the pin at each corner, on it and beside it', bounded, () =>
  with_server(
    ['--scene', 'seed-fig15-corners', '--paused'],
    async (page, script) => {
      await hold_long_presses(page);
      const fingers = await fingers_on(page);
      const home = await camera_at_rest(page);
      const corners = (await script.query('pins')).map(({ particle }) => particle);
      const middle = await pixel_of(page, await middle_of(script));
      for (const beside of [0, 20]) {
        await script.reset();
        await until(async () => (await read(page, 'pins')).length === corners.length);
        for (const particle of corners) {
          const pixel = await pixel_of(page, await position(script, particle));
          const [dx, dy] = [pixel.x - middle.x, pixel.y - middle.y];
          const out = beside / Math.hypot(dx, dy);
          await fingers.press(0, { x: pixel.x + dx * out, y: pixel.y + dy * out });
          await until(async () => (await long_presses(page)) === 1, 'a finger rests on the pin');
          await end_long_presses(page);
          const free = (pins) => !pins.some((pin) => pin.particle === particle);
          const freed = `the pin of particle ${particle} is free`;
          await until(async () => free(await script.query('pins')), freed);
          await until(async () => free(await read(page, 'pins')), `${freed} on the page`);
          await fingers.lift(0);
        }
      }
      assert.deepEqual(await script.query('pins'), []);
      assert.deepEqual(await camera_at_rest(page), home, 'the view stays where it was');
    },
    { width: 390, height: 844, touch: true },
  ),
);

async function middle_of(script) {
  const positions = await script.query('positions');
  return [0, 1, 2].map((axis) => positions.reduce((sum, p) => sum + p[axis], 0) / positions.length);
}

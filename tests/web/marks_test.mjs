import assert from 'node:assert/strict';
import test from 'node:test';
import { camera_at_rest, read, until } from './support/browser.mjs';
import { with_page, with_server } from './support/default_page.mjs';
import { bounded, drag_cloth, point_at_cloth, pulling, shows_last_tick } from './support/default_scene.mjs';

// What is drawn around hands: the ring where one takes the cloth, and the force of one that holds.

test('the ring has the radius of what a hand takes, which [ and ] change', bounded, () =>
  with_page({ paused: true }, async (page, script) => {
    await point_at_cloth(page);
    const { radius } = await read(page, 'ring');
    await page.keyboard.press(']');
    await page.keyboard.press(']');
    const between = (a, b) => Math.hypot(...a.map((value, axis) => value - b[axis]));
    // In cloth that hangs nearly flat the ring is about as wide as the disc.
    const wider = await until(async () => {
      const ring = await read(page, 'ring');
      const width = Math.max(0, ...ring.points.flatMap((a) => ring.points.map((b) => between(a, b))));
      return ring.radius > radius * 1.5 && Math.abs(width / (2 * ring.radius) - 1) < 0.1 && ring;
    }, 'it grows, and is drawn at its true size');
    await page.mouse.down();
    await until(() => script.last.grabs.length === 1);
    assert.ok(Math.abs(script.last.grabs[0].radius - wider.radius) < 1e-6);
    await until(async () => (await read(page, 'ring')).points.length === 0, 'who holds needs no ring');
    await page.mouse.up();
    for (let n = 0; n < 40; n++) await page.keyboard.press('[');
    await until(async () => (await read(page, 'ring')).radius === 0.005, 'it stays a ring');
  }),
);

test('a hand that pulls tells its force', bounded, () =>
  with_page({ paused: true }, async (page, script) => {
    await drag_cloth(page, 60, -80);
    await pulling(page, script);
    await script.advance(30);
    await shows_last_tick(page, script);
    const [{ force }] = await script.query('grabs');
    const size = Math.hypot(...force);
    assert.ok(size > 0.2, `${size} N`);
    await until(async () => {
      const text = await page.locator('.name').textContent();
      const told = /^(\d+(?:\.\d)?) N$/.exec(text)?.[1];
      return told && Math.abs(told - size) < 0.06 + 0.05 * size;
    }, 'it is written beside the hand');
    await until(async () => {
      const [hand] = await read(page, 'hands');
      return Math.abs(hand.force - size) < 1e-3 * size;
    }, 'the hand knows it');
    await page.mouse.up();
    await until(() => page.locator('.name').count().then((count) => count === 0));
  }),
);

test('the label of a hand behind an object is fainter', bounded, () =>
  with_server(['--scene', 'drape-sphere', '--paused'], async (page, script) => {
    const { position } = await camera_at_rest(page);
    const ball = (await script.query('colliders')).find(({ name }) => name !== 'ground');
    // In front of the ball and behind it, on one line from the eye.
    const at = (part) => ball.position.map((v, k) => v + part * (position[k] - v));
    await script.drag({ particle: 0 }, { target: at(0.4) });
    const hidden = async () => (await read(page, 'hands'))[0]?.hidden;
    await until(async () => (await hidden()) === false);
    await script.drag({ particle: 5 }, { target: at(-0.4) });
    await until(async () => {
      const hands = await read(page, 'hands');
      return hands.length === 2 && hands.some((hand) => hand.hidden);
    }, 'both are drawn, and one is hidden');
    assert.equal(await page.locator('.name[data-hidden]').count(), 1);
  }),
);

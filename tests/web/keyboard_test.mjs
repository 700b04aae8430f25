import assert from 'node:assert/strict';
import test from 'node:test';
import { camera_at_rest, read, until } from './support/browser.mjs';
import { with_page } from './support/default_page.mjs';
import { bounded, drag_cloth, pass, position, pulling } from './support/default_scene.mjs';

// The cloth by the keyboard alone, and the first visit.

const said = (page) => page.locator('#announcer').textContent();

test('the keyboard alone takes, moves, pins and lets go, and says what it does', bounded, () =>
  with_page({ paused: true }, async (page, script) => {
    const home = await camera_at_rest(page);
    // Tab leads to the view before anything else is reached by a pointer.
    await page.evaluate(() => document.getElementById('view').focus());
    await page.keyboard.press('c');
    await until(async () => (await read(page, 'ring')).points.length > 0, 'the cursor is on the cloth');
    assert.equal(await said(page), 'Cursor on the cloth');
    const middle = async () => {
      const { points } = await read(page, 'ring');
      return points.reduce((sum, [x]) => sum + x / points.length, 0);
    };
    const first = await middle();
    for (let n = 0; n < 3; n++) await page.keyboard.press('ArrowRight');
    await until(async () => (await middle()) > first + 0.01, 'it moves');
    await page.keyboard.press('Enter');
    await until(() => script.last.grabs.length === 1, 'it holds');
    assert.equal(await said(page), 'Holding');
    const [{ triangle }] = script.last.grabs;
    const triangles = await read(page, 'triangles');
    const particle = triangles[triangle * 3];
    const height = (await position(script, particle))[1];
    for (let n = 0; n < 10; n++) await page.keyboard.press('ArrowUp');
    await pass(page, script, async () => (await position(script, particle))[1] > height + 0.1, 'it is lifted');
    const distance = ([{ target }]) =>
      Math.hypot(...target.map((value, axis) => value - home.position[axis]));
    const before = distance(await pulling(page, script));
    for (let n = 0; n < 3; n++) await page.keyboard.press('Shift+ArrowUp');
    await until(
      async () => distance(await script.query('grabs')) > before * 1.05,
      'it goes away from the eye',
    );
    const pins = (await script.query('pins')).length;
    await page.keyboard.press('m');
    await until(async () => (await script.query('pins')).length === pins + 1, 'a pin is there');
    assert.equal(await said(page), 'Pinned');
    // However far the cloth is carried, the view waits until it is let go.
    assert.deepEqual(await camera_at_rest(page), home, 'the view stayed where it was');
    await page.keyboard.press('Enter');
    await until(() => script.last.grabs.length === 0);
    assert.equal(await said(page), 'Let go');
    await page.keyboard.press('Escape');
    const rest = await camera_at_rest(page);
    await page.keyboard.press('ArrowRight');
    await until(async () => (await camera_at_rest(page)).position[0] !== rest.position[0]);
  }),
);

test('the keyboard’s hand lets go when the window loses the focus', bounded, () =>
  with_page({ paused: true }, async (page, script) => {
    await page.evaluate(() => document.getElementById('view').focus());
    await page.keyboard.press('c');
    await page.keyboard.press('Enter');
    await until(() => script.last.grabs.length === 1);
    await page.evaluate(() => window.dispatchEvent(new Event('blur')));
    await until(() => script.last.grabs.length === 0);
  }),
);

test('a first visit: open, drag, M make a lifted, pinned cloth', bounded, () =>
  with_page({}, async (page, script) => {
    const before = await script.query('positions');
    const pins = new Set((await script.query('pins')).map(({ id }) => id));
    const particle = await drag_cloth(page, 20, -110);
    const height = before[particle][1];
    await until(async () => (await position(script, particle))[1] > height + 0.1, 'it is lifted');
    await page.keyboard.press('m');
    const pin = await until(() => script.last.pins.find(({ id }) => !pins.has(id)), 'it is pinned');
    await page.mouse.up();
    await until(() => script.last.grabs.length === 0);
    const { tick } = await script.query('state');
    await until(async () => (await script.query('state')).tick > tick + 60);
    const lift = (await position(script, pin.particle))[1] - before[pin.particle][1];
    assert.ok(lift > 0.05, `it stays lifted, by ${lift} m`);
  }),
);

import assert from 'node:assert/strict';
import test from 'node:test';
import { camera_at_rest, done, next_pictures, open_page, pixel_of, read, until } from './support/browser.mjs';
import { browser, server, with_page, with_server } from './support/default_page.mjs';
import {
  CALM,
  COLUMNS,
  bounded,
  drag_cloth,
  pass,
  point_at_cloth,
  position,
  pulling,
  show_controls,
  shows_last_tick,
} from './support/default_scene.mjs';

// Hands by the mouse, on the cloth and beside it.

test('a mouse lifts the cloth, M pins it there and frees it again', bounded, () =>
  with_page({ paused: true }, async (page, script) => {
    const before = await script.query('positions');
    const particle = await drag_cloth(page, 20, -110);
    const height = before[particle][1];
    const [hand] = await until(async () => {
      const hands = await read(page, 'hands');
      return hands.length === 1 && hands;
    }, 'the hand is drawn');
    assert.equal(hand.own, true);
    await pass(page, script, async () => (await position(script, particle))[1] > height + 0.1, 'it is lifted');
    const pins = new Set((await script.query('pins')).map(({ id }) => id));
    await page.keyboard.press('m');
    const pin = await until(() => script.last.pins.find(({ id }) => !pins.has(id)), 'it is pinned');
    await page.mouse.up();
    await until(() => script.last.grabs.length === 0);
    const held = await position(script, pin.particle);
    await script.advance(60);
    assert.deepEqual(await position(script, pin.particle), held);
    await shows_last_tick(page, script);
    await until(async () => (await read(page, 'pins')).some(({ id }) => id === pin.id), 'the page shows the pin');
    await camera_at_rest(page); // it may have followed the cloth
    const { x, y } = await pixel_of(page, pin.position);
    await page.mouse.move(x, y);
    await page.keyboard.press('m');
    await until(async () => (await script.query('pins')).every(({ id }) => pins.has(id)), 'it is freed');
    await pass(page, script, async () => (await position(script, pin.particle))[1] < held[1] - 0.05, 'it falls');
  }),
);

test('figures of time are told, but latency only while a hand holds in a running room', bounded, () =>
  with_page({ paused: true }, async (page, script) => {
    const told = () =>
      page.evaluate(() => {
        const value = document.getElementById('latency');
        return value.closest('div').hidden ? null : Number(value.textContent);
      });
    await drag_cloth(page, 0, -20);
    await until(() => script.last.grabs.length === 1);
    const { tick } = await script.advance(10);
    await until(async () => (await read(page, 'tick')) === tick);
    await next_pictures(page);
    assert.equal(await told(), null, 'nothing is told of a pause');
    await script.resume();
    await until(async () => {
      if ((await told()) !== null) return true;
      // A slow machine may have lost the hand, whose lease runs now.
      if ((await read(page, 'input')) === 'holding') return false;
      await page.mouse.up();
      await drag_cloth(page, 0, -20);
      return false;
    }, 'it is told while the room runs');
    for (const name of ['Ticks', 'Real time', 'Step']) {
      const value = page.locator('#measurements div', { hasText: name }).locator('output');
      await until(async () => /^\d+(\.\d+)?$/.test(await value.textContent()), `${name} is told`);
    }
    await page.mouse.up();
    await until(async () => (await told()) === null, 'it is forgotten when the hand lets go');
  }),
);

test('the wheel moves a hand along the view, and only without one the camera', bounded, () =>
  with_page({ paused: true }, async (page, script) => {
    await drag_cloth(page, 0, -20);
    const camera = await camera_at_rest(page);
    const distance = ([{ target }]) => Math.hypot(...target.map((value, axis) => value - camera.position[axis]));
    const first = distance(await pulling(page, script));
    await page.mouse.wheel(0, -400);
    await until(
      async () => distance(await script.query('grabs')) > first * 1.1,
      'the hand goes away from the viewer',
    );
    assert.deepEqual(await camera_at_rest(page), camera);
    await page.mouse.up();
    await until(() => script.last.grabs.length === 0);
    await page.mouse.wheel(0, -400);
    const eye = ({ position: [x, y, z] }) => Math.hypot(x, y - 1.17, z); // from the cloth's middle
    const farther = eye(camera);
    await until(async () => eye(await camera_at_rest(page)) < farther - 0.2, 'it comes nearer');
  }),
);

test('beside the cloth the mouse moves the camera and nothing else', bounded, () =>
  with_page({}, async (page, script) => {
    const home = await camera_at_rest(page);
    const length = ({ position: [x, y, z] }) => Math.hypot(x, y, z);
    const sweep = async (button, keys = []) => {
      for (const key of keys) await page.keyboard.down(key);
      await page.mouse.move(60, 200);
      await page.mouse.down({ button });
      await page.mouse.move(140, 180, { steps: 2 });
      await done(page);
      assert.deepEqual(await script.query('grabs'), [], `${button} takes nothing`);
      await page.mouse.up({ button });
      for (const key of keys) await page.keyboard.up(key);
      return camera_at_rest(page);
    };
    const rotation = ({ view }) =>
      [0, 1, 2, 4, 5, 6, 8, 9, 10].map((i) => Math.round(view[i] * 1e9) + 0);
    const orbited = await sweep('left');
    assert.notDeepEqual(rotation(orbited), rotation(home));
    const panned = await sweep('right');
    assert.deepEqual(rotation(panned), rotation(orbited));
    assert.notDeepEqual(panned.position, orbited.position);
    const panned_too = await sweep('left', ['Shift']);
    assert.deepEqual(rotation(panned_too), rotation(orbited));
    assert.notDeepEqual(panned_too.position, panned.position);
    await page.mouse.wheel(0, 300);
    await until(async () => length(await camera_at_rest(page)) > length(panned_too), 'the wheel leads away');
    await page.keyboard.press('f');
    const { target } = await until(async () => {
      const { position } = await read(page, 'camera');
      const near = (other) => Math.hypot(...other.map((value, axis) => value - position[axis])) < 1e-3;
      return (await script.query('camera')).find((seen) => near(seen.position));
    }, 'the server knows the camera');
    assert.equal(target.length, 3);
  }),
);

test('a sling waits for the hand to let go; what breaks the hold off does not throw', bounded, () =>
  with_server([...CALM, '--paused', '--set', 'environment.drag=5'], async (page, script) => {
    await page.keyboard.press('s');
    const sling = page.locator('#sling'); // put away in so small a window
    assert.equal(await sling.getAttribute('aria-pressed'), 'true');
    // Step by step, and once the cloth hangs still: what moves it then is the hand.
    await script.advance(300);
    await shows_last_tick(page, script);
    const particle = await drag_cloth(page, 90, -60);
    const [{ mode }] = await pulling(page, script);
    assert.equal(mode, 'sling');
    const velocity = async () => (await script.query('velocities'))[particle];
    const before = await velocity();
    const change = async () => Math.hypot(...(await velocity()).map((v, k) => v - before[k]));
    await script.advance(3);
    assert.ok(Math.hypot(...(await script.query('grabs'))[0].force) > 1, 'the sling is drawn');
    assert.ok((await change()) < 0.3, 'the cloth is left alone');
    await page.evaluate(() => window.dispatchEvent(new Event('blur')));
    await until(() => script.last.grabs.length === 0);
    await script.advance(3);
    assert.ok((await change()) < 0.3, 'it was not thrown');
    await page.mouse.up();
    await shows_last_tick(page, script);
    await drag_cloth(page, 90, -60);
    await pulling(page, script);
    await page.mouse.up();
    await until(() => script.last.grabs.length === 0);
    await script.advance(3);
    assert.ok((await change()) > 0.5, 'it is thrown');
    await show_controls(page);
    await sling.click();
    assert.equal(await sling.getAttribute('aria-pressed'), 'false');
  }),
);

test('two pages see each other’s hands, with names and colours', bounded, () =>
  with_page({ name: 'Ada', paused: true }, async (ada, script) => {
    const ben = await open_page(browser, server.url, { name: 'Ben' });
    try {
      const of = async (page, name) => (await read(page, 'hands')).find((hand) => hand.name === name);
      await drag_cloth(ada, 40, -40);
      const seen = await until(() => of(ben, 'Ada'), 'Ben sees the hand of Ada');
      const roster = await script.query('roster');
      const color = (name) => roster.find((viewer) => viewer.name === name).color;
      assert.equal(seen.color, color('Ada'));
      assert.equal(seen.own, false);
      assert.match(await ben.locator('.name').textContent(), /^Ada( · [\d.]+ N)?$/);
      await point_at_cloth(ben, 18 * COLUMNS + 8);
      await ben.mouse.down();
      await until(() => of(ada, 'Ben'), 'Ada sees the hand of Ben');
      await until(() => script.last.grabs.length === 2);
      assert.notEqual(color('Ada'), color('Ben'));
      await ada.mouse.up();
      await until(async () => !(await of(ben, 'Ada')), 'Ada let go');
      assert.deepEqual(ben.complaints, []);
    } finally {
      await ben.context().close();
    }
    await until(() => script.last.grabs.length === 0, 'who leaves lets go');
  }),
);

test('a drag ends when the pointer is cancelled and when the window loses the focus', bounded, () =>
  with_page({ paused: true }, async (page, script) => {
    for (const name of ['pointercancel', 'blur']) {
      await drag_cloth(page, 0, -20);
      await until(() => script.last.grabs.length === 1);
      await page.evaluate((type) => {
        const target = type === 'blur' ? window : document.getElementById('view');
        target.dispatchEvent(new PointerEvent(type, { pointerId: 1 }));
      }, name);
      await until(() => script.last.grabs.length === 0, `${name} ends the drag`);
      assert.equal(await read(page, 'input'), 'idle');
      await page.mouse.up();
    }
  }),
);

test('the hands of a hard case are drawn, as the scene’s', bounded, () =>
  with_server(['--scene', 'hard-ten-hands', '--paused'], async (page, script) => {
    await script.advance(130);
    const grabs = await script.query('grabs');
    assert.equal(grabs.length, 10);
    const hands = await until(async () => {
      const shown = await read(page, 'hands');
      const there = ({ id, target }) =>
        shown.some((hand) => hand.id === id && Math.hypot(...hand.target.map((v, k) => v - target[k])) < 1e-4);
      return grabs.every(there) && shown;
    }, 'each is where it pulls to');
    assert.deepEqual(new Set(hands.map(({ name }) => name)), new Set(['scene']));
  }),
);

import assert from 'node:assert/strict';
import test from 'node:test';
import { camera_at_rest, done, next_pictures, open_page, pixel_of, read, until } from './support/browser.mjs';
import { browser, server, with_page, with_server } from './support/default_page.mjs';
import {
  COLUMNS,
  bounded,
  particle_pixel,
  position,
  show_controls,
  shows_last_tick,
} from './support/default_scene.mjs';

// Fans and objects that hands move.

test('a fan is seen by all, blows at the cloth, and is moved, aimed and set by hand', bounded, () =>
  with_page({}, async (page, script) => {
    const fans = async () => (await script.query('state')).fans;
    const fan_of = async (wanted = () => true) =>
      until(async () => {
        const [fan] = await fans();
        return fan && wanted(fan) && fan;
      }, `the server has the fan: ${wanted}`);
    await camera_at_rest(page);
    await page.keyboard.press('w');
    const made = await fan_of();
    const other = await open_page(browser, server.url);
    await until(async () => (await read(other, 'fans')).length === 1, 'others see it');
    await other.context().close();
    const speeds = async () => (await script.query('velocities')).map((v) => Math.hypot(...v));
    await until(async () => Math.max(...(await speeds())) > 0.3, 'the cloth moves');
    const work = await script.query('work');
    assert.ok(work.find(({ stage }) => stage === 'fans').work > 0);

    const camera = await camera_at_rest(page);
    /** Waits until the page shows the fan as the server has it. */
    const shown = async (fan) => {
      const same = (own) => own && JSON.stringify(own.position.concat(own.direction)) ===
        JSON.stringify(fan.position.concat(fan.direction));
      await until(async () => same((await read(page, 'fans'))[0]), 'the page shows the fan there');
    };
    const drag = async (point, dx, dy) => {
      const { x, y } = await pixel_of(page, point);
      await page.mouse.move(x, y);
      await page.mouse.down();
      await until(async () => (await read(page, 'input')) === 'holding');
      await page.mouse.move(x + dx, y + dy, { steps: 3 });
      await page.mouse.up();
      return { x: x + dx, y: y + dy };
    };
    const near = (a, b) => Math.hypot(a.x - b.x, a.y - b.y) < 1;
    await shown(made);
    const hub = await drag(made.position, -30, -40);
    await done(page);
    assert.ok(near(hub, await pixel_of(page, (await fan_of()).position)), 'it is where the hand let go');
    const moved = await fan_of();
    assert.ok(moved.position[1] > made.position[1] + 0.05, `${moved.position}`);
    assert.deepEqual(moved.direction, made.direction);

    const tip = ({ position, direction }) => position.map((v, axis) => v + direction[axis] * 0.6);
    await shown(moved);
    await drag(tip(moved), 0, -60);
    await done(page); // the fan as the hand let it go
    const aimed = await fan_of(({ direction }) => direction[1] > moved.direction[1] + 0.1);
    assert.deepEqual(aimed.position, moved.position);
    assert.ok(Math.abs(Math.hypot(...aimed.direction) - 1) < 1e-9);
    assert.deepEqual(await script.query('grabs'), [], 'no hand is in the cloth');
    assert.deepEqual(await camera_at_rest(page), camera);

    // The cloth hangs where it starts, however long the fan has blown.
    await script.pause();
    await script.reset();
    await until(async () => (await read(page, 'tick')) === 0);
    const behind = await position(script, 4 * COLUMNS + 14);
    const before = behind.map((value, axis) => value + 0.3 * (camera.position[axis] - value));
    await script.set({ fans: [{ position: before, direction: [1, 0, 0] }] });
    await until(async () => (await read(page, 'fans'))[0].position[0] === before[0]);
    await camera_at_rest(page);
    const over = await pixel_of(page, before);
    await page.mouse.move(over.x, over.y);
    await page.keyboard.press('m');
    await done(page);
    const first = new Set((await script.query('pins')).map(({ id }) => id));
    assert.equal(first.size, 6, 'what is behind the fan is not pinned');
    const beside = await particle_pixel(page, 4 * COLUMNS + 6);
    await page.mouse.move(beside.x, beside.y);
    await page.keyboard.press('m');
    const pinned = await until(
      async () => (await script.query('pins')).find(({ id }) => !first.has(id)),
      'the cloth beside it is pinned',
    );
    await script.release({ pin: pinned.id });
    await script.resume();

    await show_controls(page);
    await page.getByRole('slider', { name: 'Fan' }).fill('12');
    await fan_of(({ speed }) => speed === 12);
    await until(async () => (await read(page, 'fans'))[0]?.speed === 12, 'the page knows it');
    await page.keyboard.press('w');
    await until(async () => (await fans()).length === 0);
    await until(() => page.getByRole('slider', { name: 'Fan' }).isHidden());
  }),
);

test('an object is drawn where it is, and goes where Ctrl, Shift and the mouse take it', bounded, () =>
  with_server(['--scene', 'lift-sphere', '--paused'], async (page, script) => {
    const round = ({ name }) => name === 'ball' || name === 'sphere';
    const ball = async () => (await read(page, 'objects')).find(round);
    const asked = async () => (await script.query('colliders')).find(round);
    await script.advance(130); // on its way up
    await until(async () => (await read(page, 'tick')) === 130);
    const { position } = await asked();
    assert.ok(position[1] > 0.4 && position[1] < 0.9, `${position}`);
    await until(async () => Math.abs((await ball()).position[1] - position[1]) < 1e-5);

    // Here the cloth does not hide it.
    await script.load('drape-sphere');
    await until(async () => (await read(page, 'scene')) === 'drape-sphere');
    await until(async () => (await read(page, 'tick')) === 0, 'it is framed as it is shown');
    await camera_at_rest(page);
    const { x, y } = await pixel_of(page, [0, 0.65, 0.15]); // below the cloth's edge
    await page.keyboard.down('Control');
    await page.keyboard.down('Shift');
    await page.mouse.move(x, y);
    await page.mouse.down();
    await until(async () => (await read(page, 'input')) === 'holding');
    await page.mouse.move(x + 120, y, { steps: 4 });
    await page.mouse.up();
    await page.keyboard.up('Shift');
    await page.keyboard.up('Control');
    await script.resume();
    await until(async () => Math.hypot(...(await asked()).position.filter((_, k) => k !== 1)) > 0.1);
    await script.pause();
    const goal = (await asked()).position;
    await until(async () => Math.hypot(...(await ball()).position.map((v, k) => v - goal[k])) < 1e-5);
  }),
);

test('each leg of a table moves by itself, by a plain drag where objects are moved', bounded, () =>
  with_server(['--scene', 'table', '--paused'], async (page, script) => {
    const legs = async () =>
      (await script.query('colliders')).filter(({ name }) => name === 'leg').map((leg) => leg.position);
    await page.keyboard.press('o');
    assert.equal(await page.locator('#objects').getAttribute('aria-pressed'), 'true');
    await camera_at_rest(page);
    assert.equal((await legs()).length, 4);
    const moved = new Set();
    for (const place of await legs()) {
      await camera_at_rest(page); // it may have followed the cloth
      const free = async ({ x, y }) =>
        (await page.evaluate(([a, b]) => document.elementFromPoint(a, b)?.id, [x, y])) === 'view';
      let at = await pixel_of(page, [place[0], 0.1, place[2]]);
      // The toolbar may be before a foot.
      for (let height = 0.2; !(await free(at)); height += 0.1)
        at = await pixel_of(page, [place[0], height, place[2]]);
      const { x, y } = at;
      await page.mouse.move(x, y);
      await page.mouse.down();
      await until(async () => (await read(page, 'input')) !== 'idle');
      const holds = (await read(page, 'input')) === 'holding'; // the cloth may hide a leg
      const before = await legs();
      if (holds) await page.mouse.move(x + 30, y, { steps: 3 });
      await page.mouse.up();
      if (!holds) continue;
      await done(page); // it goes to where the hand let go
      const which = await until(async () => {
        await script.advance(5);
        const ways = (await legs()).map((now, leg) =>
          Math.hypot(...now.map((value, axis) => value - before[leg][axis])),
        );
        const moving = ways.flatMap((way, leg) => (way > 0.01 ? [leg] : []));
        return moving.length && moving;
      }, 'a leg moves');
      assert.equal(which.length, 1, 'one leg alone moves');
      moved.add(which[0]);
      await until(async () => {
        const now = JSON.stringify(await legs());
        await script.advance(5);
        return JSON.stringify(await legs()) === now;
      }, 'it arrives');
      await shows_last_tick(page, script);
    }
    assert.ok(moved.size >= 2, `legs that moved: ${[...moved]}`);
  }),
);

test('a hand carries a gripper, and a click closes and opens it', bounded, () =>
  with_server(['--scene', 'gripper', '--paused'], async (page, script) => {
    await page.setViewportSize({ width: 900, height: 700 });
    await until(async () => (await read(page, 'size')).width === 900);
    const state = async () => (await script.query('grippers'))[0];
    await camera_at_rest(page);
    const start = await state();
    const jaw = async () => {
      const { position } = (await read(page, 'objects')).find(({ name }) => name === 'gripper.right');
      return pixel_of(page, position);
    };
    const press = async () => {
      await camera_at_rest(page);
      const { x, y } = await jaw();
      await until(async () => {
        await page.mouse.move(x, y);
        await next_pictures(page);
        return (await page.locator('#view').getAttribute('data-cursor')) === 'grab';
      }, 'the page knows that it can be taken');
      await page.mouse.down();
      await until(async () => (await read(page, 'input')) === 'holding', 'a jaw is held');
      return { x, y };
    };
    const passing = (holds) =>
      until(async () => {
        await script.advance(5);
        return holds(await state());
      }, `${holds}`);
    await press();
    await page.mouse.up();
    await passing(({ opening }) => opening < start.opening / 4);
    await shows_last_tick(page, script);
    const middle = async () => pixel_of(page, (await state()).position);
    const from = await middle();
    const { x, y } = await press();
    await page.mouse.move(x, y - 80, { steps: 4 });
    await page.mouse.up();
    await done(page);
    await until(async () => {
      await script.advance(5);
      const at = await middle();
      return Math.hypot(at.x - from.x, at.y - (from.y - 80)) < 4; // pixels
    }, 'the gripper goes as far as the hand');
    await page.keyboard.press('g');
    await passing(({ opening }) => opening > start.opening * 0.9);
  }),
);

test('the head of a pin that a script moves goes with its cloth', bounded, () =>
  with_page({ paused: true }, async (page, script) => {
    const [pin] = await script.query('pins');
    const target = pin.position.map((value, axis) => value + [0, 0.1, 0.3][axis]);
    const place = async () => (await script.query('pins'))[0].position;
    await script.move(pin.id, { position: target, seconds: 1 });
    await script.advance(30);
    const half = await place();
    const head_is_at = async (point) => {
      const [head] = await read(page, 'pin_heads');
      return head && Math.hypot(...head.map((value, axis) => value - point[axis])) < 2e-4; // the page's frames are rounded
    };
    await until(() => head_is_at(half), 'half way');
    assert.ok(half[2] - pin.position[2] > 0.1 && target[2] - half[2] > 0.1, `${half}`);
    await script.move(pin.id, { stop: true });
    await script.advance(30);
    assert.deepEqual(await place(), half);
    await script.move(pin.id, { position: target });
    await script.advance(60);
    await until(() => head_is_at(target), 'there');
  }),
);

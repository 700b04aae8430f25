import assert from 'node:assert/strict';
import test, { after, before } from 'node:test';
import {
  camera_at_rest,
  launch_browser,
  next_pictures,
  open_page,
  pixel_of,
  read,
  until,
} from './support/browser.mjs';
import { import_page_module } from './support/page_module.mjs';
import { start_server } from './support/server.mjs';
import { brightness_at, cloth_on_canvas, compare, projected_cloth } from './support/silhouette.mjs';

const { inner_offset } = await import_page_module('normals');
const CALM = ['--set', 'environment.wind=0,0,0', '--set', 'environment.gust_speed=0'];
const COLUMNS = 30; // of the default scene's grid
const bounded = { timeout: 300_000 };

let browser;
let server;
before(async () => {
  browser = await launch_browser();
  server = await start_server(CALM);
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

/** Gives a test a page and a script at the default scene's start, and sees them off. */
async function with_page(options, act) {
  const script = await server.script();
  await script.release({ all: true });
  await script.resume();
  await script.reset();
  const page = await open_page(browser, server.url, options);
  try {
    await act(page, script);
    assert.deepEqual(page.complaints, []);
  } finally {
    await page.context().close();
    script.close();
  }
}

const position = async (script, particle) => (await script.query('positions'))[particle];

/** Where the page shows a particle of the cloth. */
async function particle_pixel(page, particle) {
  const positions = await read(page, 'positions');
  return pixel_of(page, positions.slice(particle * 3, particle * 3 + 3));
}

/** A particle near the middle of the cloth, and the mouse upon it. */
async function point_at_cloth(page, particle = 4 * COLUMNS + 14) {
  await camera_at_rest(page);
  await until(async () => {
    const { x, y } = await particle_pixel(page, particle);
    await page.mouse.move(x, y);
    await next_pictures(page);
    return read(page, 'hovering');
  }, 'the mouse is on the cloth');
  return particle;
}

/** Takes the cloth with the mouse and moves the hand by so many pixels. */
async function drag_cloth(page, dx, dy) {
  const particle = await point_at_cloth(page);
  const { x, y } = await particle_pixel(page, particle);
  await page.mouse.down();
  await until(async () => (await read(page, 'input')) === 'holding');
  await page.mouse.move(x + dx, y + dy, { steps: 4 });
  return particle;
}

/** The cloth of the page's picture and of the server's positions, from where the page looks. */
async function silhouettes(page, script) {
  const { values } = await script.query('positions', { format: 'f64' });
  const camera = await camera_at_rest(page);
  await until(() => read(page, 'fine'), 'the still picture is a fine one');
  const { announcement, data } = script.mesh;
  // The page draws objects thinner by the cloth's thickness.
  const [{ thickness }] = announcement.cloths;
  const objects = data.colliders.map(({ positions, triangles }) => ({
    positions: inner_offset(positions, triangles, thickness),
    triangles,
  }));
  const size = await read(page, 'size');
  const cloth = { positions: values, triangles: data.triangles };
  const expected = projected_cloth(camera, size, cloth, objects);
  return compare(await cloth_on_canvas(page), expected, size.width);
}

async function turn_view(page, pixels) {
  await page.mouse.move(600, 300);
  await page.mouse.down();
  await page.mouse.move(600 + pixels, 300);
  await page.mouse.up();
  await page.mouse.move(1, 1);
}

test('the cloth on the canvas is the projection of the positions of the server', bounded, () =>
  with_page({ width: 720, height: 540 }, async (page, script) => {
    for (const turn of [0, -160]) {
      await turn_view(page, turn);
      await script.pause();
      const { overlap, area } = await silhouettes(page, script);
      assert.ok(overlap >= 0.98, `turned by ${turn} pixels: ${overlap}`);
      assert.ok(area > 12_000, `the cloth is in the picture: ${area} pixels`);
      await script.resume();
    }
  }),
);

// A pixel on the outline belongs to whoever has more of it, so that about one in five of them differs
// between two ways of drawing. Seen almost edge-on a cloth is little more than its outline, and its
// overlap falls to 0.95 though nothing is out of place. What is tested there is that
// pixels differ on the outline alone, and no more of them than anywhere else.
test('a cloth seen edge-on differs from its projection on the outline alone', bounded, () =>
  with_page({ width: 720, height: 540 }, async (page, script) => {
    await script.pause();
    const seen = [];
    for (const turn of [-380, -20]) {
      await turn_view(page, turn);
      const { outline, differing, inside, area } = await silhouettes(page, script);
      assert.equal(inside, 0, `turned by ${turn} pixels`);
      assert.ok(differing < 0.35 * outline, `${differing} of ${outline} pixels of the outline`);
      seen.push(area / outline);
    }
    assert.ok(Math.min(...seen) < 10, `it is seen almost edge-on: ${seen}`);
  }),
);

test('no vertex moves while ticks stand still; a step moves them by one tick', bounded, () =>
  with_page({}, async (page, script) => {
    await page.keyboard.press(' ');
    await until(async () => (await script.query('state')).paused);
    await until(() => page.evaluate(() => weft.paused));
    await next_pictures(page);
    const shown = await read(page, 'positions');
    const { values } = await script.query('positions', { format: 'f32' });
    assert.deepEqual(shown, [...values]);
    const pictures = await read(page, 'pictures');
    for (let i = 0; i < 6; i++) {
      await page.mouse.move(200 + i * 20, 200);
      await next_pictures(page);
      assert.deepEqual(await read(page, 'positions'), shown);
    }
    assert.ok((await read(page, 'pictures')) > pictures, 'pictures were drawn meanwhile');
    const tick = await read(page, 'tick');
    await page.keyboard.press('.');
    await until(async () => (await read(page, 'tick')) === tick + 1);
    assert.notDeepEqual(await read(page, 'positions'), shown);
    await page.keyboard.press(' ');
    await until(async () => (await read(page, 'tick')) > tick + 5);
  }),
);

test('a mouse lifts the cloth, M pins it there and frees it again', bounded, () =>
  with_page({}, async (page, script) => {
    const before = await script.query('positions');
    const particle = await drag_cloth(page, 20, -110);
    const height = before[particle][1];
    await until(async () => (await position(script, particle))[1] > height + 0.1, 'it is lifted');
    const [hand] = await read(page, 'hands');
    assert.equal(hand.own, true);
    for (const name of ['Ticks', 'Real time', 'Step', 'Latency']) {
      const value = page.locator('#measurements div', { hasText: name }).locator('output');
      await until(async () => /^\d+(\.\d+)?$/.test(await value.textContent()), `${name} is told`);
    }
    const pins = script.last.pins.length;
    await page.keyboard.press('m');
    await until(() => script.last.pins.length === pins + 1);
    await page.mouse.up();
    await until(() => script.last.grabs.length === 0);
    const pin = script.last.pins.at(-1);
    const held = await position(script, pin.particle);
    const { tick } = await script.query('state');
    await until(async () => (await script.query('state')).tick > tick + 60);
    assert.deepEqual(await position(script, pin.particle), held);
    const { x, y } = await pixel_of(page, pin.position);
    await page.mouse.move(x, y);
    await page.keyboard.press('m');
    await until(() => script.last.pins.length === pins);
    await until(async () => (await position(script, pin.particle))[1] < held[1] - 0.05, 'it falls');
  }),
);

test('the wheel moves a hand along the view, and only without one the camera', bounded, () =>
  with_page({}, async (page, script) => {
    await drag_cloth(page, 0, -20);
    const camera = await camera_at_rest(page);
    const distance = async () => {
      const [{ target }] = script.last.grabs.length ? await script.query('grabs') : [{ target: null }];
      return target && Math.hypot(...target.map((value, axis) => value - camera.position[axis]));
    };
    const first = await until(distance, 'the server knows the hand');
    await page.mouse.wheel(0, -400);
    await until(async () => (await distance()) > first * 1.1, 'the hand goes away from the viewer');
    assert.deepEqual(await camera_at_rest(page), camera);
    await page.mouse.up();
    await until(() => script.last.grabs.length === 0);
    await page.mouse.wheel(0, -400);
    await until(async () => (await camera_at_rest(page)).position[2] < camera.position[2] - 0.2);
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
    assert.ok(length(await camera_at_rest(page)) > length(panned_too));
    await page.keyboard.press('f');
    const { target } = await until(async () => {
      const [seen] = (await script.query('camera')).filter(({ viewer }) => viewer !== script.viewer);
      return seen;
    }, 'the server knows the camera');
    assert.equal(target.length, 3);
    assert.deepEqual(script.last.grabs, []);
  }),
);

test('a sling waits for the hand to let go; what breaks the hold off does not throw', bounded, () =>
  with_page({}, async (page, script) => {
    await page.keyboard.press('s');
    const sling = page.getByRole('button', { name: 'Sling', exact: true });
    assert.equal(await sling.getAttribute('aria-pressed'), 'true');
    const particle = await drag_cloth(page, 90, -60);
    await until(() => script.last.grabs.length === 1);
    const [grab] = script.last.grabs;
    assert.equal(grab.mode, 'sling');
    const speed = async () => Math.hypot(...(await script.query('velocities'))[particle]);
    await until(async () => Math.hypot(...(await script.query('grabs'))[0].force) > 1);
    assert.ok((await speed()) < 0.3, 'the cloth is left alone');
    await page.evaluate(() => window.dispatchEvent(new Event('blur')));
    await until(() => script.last.grabs.length === 0);
    assert.ok((await speed()) < 0.3, 'it was not thrown');
    await page.mouse.up();
    await drag_cloth(page, 90, -60);
    await until(() => script.last.grabs.length === 1);
    await until(async () => Math.hypot(...(await script.query('grabs'))[0].force) > 1);
    await script.pause();
    await page.mouse.up();
    await until(() => script.last.grabs.length === 0);
    await script.advance(3);
    assert.ok((await speed()) > 0.5, 'it is thrown');
    await sling.click();
    assert.equal(await sling.getAttribute('aria-pressed'), 'false');
  }),
);

test('a fan is seen by all, blows at the cloth, and is moved, aimed and set by hand', bounded, () =>
  with_page({}, async (page, script) => {
    const fans = async () => (await script.query('state')).fans;
    const fan_of = async (wanted = () => true) =>
      until(async () => {
        const [fan] = await fans();
        return fan && wanted(fan) && fan;
      }, `the server has the fan: ${wanted}`);
    await camera_at_rest(page);
    await page.getByRole('button', { name: 'Fan', exact: true }).click();
    const made = await fan_of();
    const other = await open_page(browser, server.url);
    await until(async () => (await read(other, 'fans')).length === 1, 'others see it');
    await other.context().close();
    const speeds = async () => (await script.query('velocities')).map((v) => Math.hypot(...v));
    await until(async () => Math.max(...(await speeds())) > 0.3, 'the cloth moves');
    const work = await script.query('work');
    assert.ok(work.find(({ stage }) => stage === 'fans').work > 0);

    const camera = await camera_at_rest(page);
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
    const hub = await drag(made.position, -30, -40);
    // On a slow machine the places on the way are told too: the fan is where the hand let go last.
    await until(async () => near(hub, await pixel_of(page, (await fan_of()).position)));
    const moved = await fan_of(({ position }) => position[1] > made.position[1] + 0.05);
    assert.deepEqual(moved.direction, made.direction);

    const tip = ({ position, direction }) => position.map((v, axis) => v + direction[axis] * 0.6);
    await drag(tip(moved), 0, -60);
    const aimed = await fan_of(({ direction }) => direction[1] > moved.direction[1] + 0.1);
    assert.deepEqual(aimed.position, (await fan_of()).position);
    assert.ok(Math.abs(Math.hypot(...aimed.direction) - 1) < 1e-9);
    assert.deepEqual(script.last.grabs, [], 'no hand is in the cloth');
    assert.deepEqual(await camera_at_rest(page), camera);

    // The cloth hangs where it starts, however long the fan has blown.
    await script.pause();
    await script.reset();
    await until(async () => (await read(page, 'tick')) === 0);
    const behind = await position(script, 4 * COLUMNS + 14);
    const before = behind.map((value, axis) => value + 0.3 * (camera.position[axis] - value));
    await script.set({ fans: [{ position: before, direction: [1, 0, 0] }] });
    const over = await pixel_of(page, before);
    await page.mouse.move(over.x, over.y);
    await until(async () => (await read(page, 'fans'))[0].position[0] === before[0]);
    await page.keyboard.press('m');
    const beside = await particle_pixel(page, 4 * COLUMNS + 6);
    await page.mouse.move(beside.x, beside.y);
    await page.keyboard.press('m');
    await until(() => script.last.pins.length > 6, 'the cloth beside it is pinned');
    const [pinned] = script.last.pins.slice(6); // the first, if what is behind the fan was too
    const at = await pixel_of(page, pinned.position);
    assert.ok(Math.abs(at.y - over.y) > 25, 'and not what is behind the fan');
    await script.release({ pin: pinned.id });
    await script.resume();

    await page.getByRole('slider', { name: 'Fan' }).fill('12');
    await fan_of(({ speed }) => speed === 12);
    await page.keyboard.press('w');
    await until(async () => (await fans()).length === 0);
    await until(() => page.getByRole('slider', { name: 'Fan' }).isHidden());
  }),
);

/** Lowest and highest corner of what twelve lines surround, checked to be the edges of a box. */
function box_of_lines(lines) {
  const points = Array.from({ length: lines.length / 3 }, (_, i) => lines.slice(i * 3, i * 3 + 3));
  const low = [0, 1, 2].map((axis) => Math.min(...points.map((point) => point[axis])));
  const high = [0, 1, 2].map((axis) => Math.max(...points.map((point) => point[axis])));
  assert.equal(points.length, 24);
  const seen = new Set();
  for (let i = 0; i < points.length; i += 2) {
    const [a, b] = [points[i], points[i + 1]];
    const along = [0, 1, 2].filter((axis) => a[axis] !== b[axis]);
    assert.ok(along.length <= 1, 'a line runs along one axis');
    for (const point of [a, b]) {
      point.forEach((value, axis) => assert.ok(value === low[axis] || value === high[axis]));
    }
    seen.add(`${a} ${b}`);
  }
  if (low.every((value, axis) => value < high[axis])) assert.equal(seen.size, 12);
  return [...low, ...high];
}

test('the lines of the boxes are the server’s, for each tree and level that is chosen', bounded, () =>
  with_page({}, async (page, script) => {
    await script.pause();
    const trees = await script.query('trees');
    await page.keyboard.press('b');
    const panel = page.getByRole('region', { name: 'Boxes' });
    await until(async () => (await panel.getByRole('option').count()) === trees.length);
    const shown = async (tree, level) => {
      const boxes = await script.query('boxes', { tree, level });
      const text = `${boxes.length} ${boxes.length === 1 ? 'box' : 'boxes'}`;
      await until(async () => (await panel.locator('#box-count').textContent()) === text, text);
      const { lines } = await until(async () => {
        const found = await read(page, 'boxes');
        return found.lines.length === boxes.length * 72 && found;
      });
      const drawn = boxes.map((_, k) => box_of_lines(lines.slice(k * 72, k * 72 + 72)));
      assert.deepEqual(drawn, boxes.map((box) => box.map(Math.fround)));
    };
    for (const { tree, levels } of trees) {
      await panel.getByRole('combobox').selectOption(tree);
      for (const level of [0, 3, levels - 1]) {
        await panel.getByRole('slider', { name: 'Level' }).fill(String(level));
        await shown(tree, level);
      }
    }
    await panel.getByRole('combobox').selectOption('particles');
    await panel.getByRole('slider', { name: 'Level' }).fill('2');
    await script.advance(30);
    const { tick } = await script.query('state');
    await until(async () => (await read(page, 'boxes')).tick === tick, 'the boxes follow the cloth');
    await shown('particles', 2);
    await script.load('curtain');
    await until(async () => (await panel.getByRole('option').count()) === 3, 'it has no model');
    await until(async () => (await read(page, 'boxes')).lines.length > 0);
    await page.locator('#view').focus();
    await page.keyboard.press('b');
    await until(async () => (await read(page, 'boxes')).lines.length === 0);
    await script.load('default');
    await until(async () => (await read(page, 'scene')) === 'default');
  }),
);

test('two pages see each other’s hands, with names and colours', bounded, () =>
  with_page({ name: 'Ada' }, async (ada, script) => {
    const ben = await open_page(browser, server.url, { name: 'Ben' });
    try {
      // While the cloth rests, a hand is not lost however slowly its page draws.
      await script.pause();
      const of = async (page, name) => (await read(page, 'hands')).find((hand) => hand.name === name);
      await drag_cloth(ada, 40, -40);
      const seen = await until(() => of(ben, 'Ada'), 'Ben sees the hand of Ada');
      const roster = await script.query('roster');
      const color = (name) => roster.find((viewer) => viewer.name === name).color;
      assert.equal(seen.color, color('Ada'));
      assert.equal(seen.own, false);
      assert.equal(await ben.locator('.name').textContent(), 'Ada');
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
  with_page({}, async (page, script) => {
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

test('a hidden page asks for no frames, and goes on when it is seen again', bounded, () =>
  with_page({}, async (page, script) => {
    const hide = (hidden) =>
      page.evaluate((value) => {
        Object.defineProperty(document, 'hidden', { value, configurable: true });
        document.dispatchEvent(new Event('visibilitychange'));
      }, hidden);
    const tick = async () => (await script.query('state')).tick;
    await hide(true);
    await until(async () => {
      const last = await read(page, 'tick');
      const now = await tick();
      await until(async () => (await tick()) > now + 60);
      return (await read(page, 'tick')) === last;
    }, 'no frame comes in the time of sixty ticks');
    await hide(false);
    const seen = await tick();
    await until(async () => (await read(page, 'tick')) > seen);
  }),
);

test('what sleeps is told, and a hand wakes it', bounded, async () => {
  const restful = ['--set', 'environment.drag=20', '--set', 'sleep.after=0.5'];
  const sleepy = await start_server([...CALM, ...restful]);
  const page = await open_page(browser, sleepy.url);
  const script = await sleepy.script();
  try {
    await until(() => page.locator('#asleep').isVisible(), 'the cloth sleeps');
    assert.equal(await page.locator('#asleep').textContent(), '1');
    const { tick: then, sleeping } = await script.query('state');
    assert.deepEqual(sleeping, { islands: 1, cloths: ['cloth'] });
    // Who has just joined gets a frame, which the page may still have to show.
    await until(async () => (await script.query('state')).tick > then + 60);
    const tick = await read(page, 'tick');
    await until(async () => (await script.query('state')).tick > then + 180);
    assert.equal(await read(page, 'tick'), tick, 'no frame has come');
    await drag_cloth(page, 0, -30);
    await until(async () => !(await page.locator('#asleep').isVisible()), 'it is awake');
    await until(async () => (await read(page, 'tick')) > tick);
    await page.mouse.up();
    await until(() => page.locator('#asleep').isVisible(), 'it sleeps again');
    assert.deepEqual(page.complaints, []);
  } finally {
    script.close();
    await page.context().close();
    await sleepy.stop();
  }
});

test('after the server was away the page comes back, without the hand', bounded, async () => {
  let first = await start_server(CALM);
  let second;
  const page = await open_page(browser, first.url);
  try {
    await drag_cloth(page, 0, -30);
    await first.stop('SIGKILL');
    first = null;
    await until(async () => (await read(page, 'phase')) !== 'open');
    assert.equal(await read(page, 'input'), 'idle');
    await until(async () => (await read(page, 'hands')).length === 0);
    await page.mouse.up();
    second = await start_server(CALM, Number(new URL(page.url()).port));
    await until(async () => (await read(page, 'phase')) === 'open', 'it is connected again');
    await until(async () => (await read(page, 'tick')) > 20);
    const script = await second.script();
    await drag_cloth(page, 0, -30);
    await until(() => script.last.grabs.length === 1, 'the cloth can be taken again');
    script.close();
    // The browser itself tells of each attempt that failed.
    const own = page.complaints.filter((text) => !text.startsWith('WebSocket connection to'));
    assert.deepEqual(own, []);
  } finally {
    await page.context().close();
    await first?.stop();
    await second?.stop();
  }
});

test('one finger takes the cloth or turns, two shift and zoom, a long press pins', bounded, () =>
  with_page({ width: 400, height: 720, touch: true }, async (page, script) => {
    const session = await page.context().newCDPSession(page);
    const touch = (type, ...points) =>
      session.send('Input.dispatchTouchEvent', {
        type,
        touchPoints: points.map(([x, y], id) => ({ x, y, id })),
      });
    const particle = 4 * COLUMNS + 14;
    const home = await camera_at_rest(page);
    const height = (await position(script, particle))[1];
    const first = await particle_pixel(page, particle);
    // Both at once, so that a slow machine does not make a long press of it.
    await Promise.all([
      touch('touchStart', [first.x, first.y]),
      touch('touchMove', [first.x, first.y - 15]),
    ]);
    await until(() => script.last.grabs.length === 1, 'one finger holds the cloth');
    for (const dy of [30, 60, 90]) await touch('touchMove', [first.x, first.y - dy]);
    await until(async () => (await position(script, particle))[1] > height + 0.1, 'it is lifted');
    await touch('touchEnd');
    await until(() => script.last.grabs.length === 0);
    assert.deepEqual(await camera_at_rest(page), home);

    await touch('touchStart', [30, 480]);
    await touch('touchMove', [110, 480]);
    await touch('touchEnd');
    const turned = await camera_at_rest(page);
    assert.notDeepEqual(turned, home);
    assert.equal(script.last.grabs.length, 0);

    await touch('touchStart', [120, 470], [200, 470]);
    await touch('touchMove', [100, 470], [220, 470]);
    await touch('touchEnd');
    const zoomed = await camera_at_rest(page);
    assert.equal(script.last.grabs.length, 0);
    const distance = ({ position: [x, , z] }) => Math.hypot(x, z);
    assert.ok(distance(zoomed) < distance(turned) * 0.9);

    await page.keyboard.press('f');
    await camera_at_rest(page);
    const pins = script.last.pins.length;
    const again = await particle_pixel(page, particle);
    await touch('touchStart', [again.x, again.y]);
    await until(() => script.last.pins.length === pins + 1, 'a long press pins');
    await touch('touchEnd');
    assert.equal(script.last.grabs.length, 0);
  }),
);

test('on screens wide and narrow every control is within reach and has a name', bounded, () =>
  with_page({ width: 400, height: 720 }, async (page, script) => {
    const controls = ['button', 'slider'];
    const names = [
      ['button', 'Pause'],
      ['button', 'One step'],
      ['button', 'Reset'],
      ['button', 'Sling'],
      ['button', 'Fan'],
      ['button', 'Boxes'],
      ['button', 'Frame the cloth'],
      ['button', 'Help'],
      ['button', 'Scenes'],
      ['slider', 'Wind'],
      ['slider', 'Gravity'],
    ];
    await page.getByRole('button', { name: 'Fan', exact: true }).click();
    await until(() => page.getByRole('slider', { name: 'Fan' }).isVisible());
    for (const [width, height] of [[1100, 700], [900, 500], [700, 500], [360, 640], [400, 720]]) {
      await page.setViewportSize({ width, height });
      await until(async () => (await read(page, 'size')).width === width);
      for (const [role, name] of [...names, ['slider', 'Fan']]) {
        const box = await page.getByRole(role, { name, exact: true }).boundingBox();
        const at = `${name} in ${width} x ${height}`;
        assert.ok(box.x >= 0 && box.x + box.width <= width, `${at} across`);
        assert.ok(box.y >= 0 && box.y + box.height <= height, `${at} down`);
      }
    }
    await page.getByRole('button', { name: 'Fan', exact: true }).click();
    for (const role of controls) {
      for (const control of await page.getByRole(role).all()) {
        assert.ok(await control.evaluate((element) => element.matches('[aria-label], label *')));
      }
    }
    await page.getByRole('slider', { name: 'Wind' }).focus();
    await page.keyboard.press('End');
    const wind = async () => Math.hypot(...(await script.query('state')).wind);
    await until(async () => Math.abs((await wind()) - 10) < 1e-6, 'the slider sets the wind');
    await script.set({ wind: [0, 0, 0] });
    await page.keyboard.press('?');
    const help = page.getByRole('dialog');
    assert.ok(await help.isVisible());
    await page.keyboard.press('Escape');
    assert.ok(!(await help.isVisible()));
    await page.setViewportSize({ width: 900, height: 500 });
    await until(async () => (await read(page, 'size')).width === 900);
    const { projection } = await camera_at_rest(page);
    assert.ok(Math.abs(projection[5] / projection[0] - 900 / 500) < 1e-6, 'square pixels');
  }),
);

const scene_title = (page) => page.getByRole('button', { name: 'Scenes' }).textContent();

test('another scene is shown when one is chosen, and R starts it anew', bounded, () =>
  with_page({}, async (page, script) => {
    const other = await open_page(browser, server.url, { name: 'Ben' });
    await page.getByRole('button', { name: 'Scenes' }).click();
    const list = page.getByRole('dialog', { name: 'Scenes' });
    const known = (await (await fetch(new URL('api/v1/scenes', server.url))).json()).scenes;
    for (const { description } of known) assert.ok(await list.getByText(description).isVisible());
    const chosen = list.locator('[aria-current]');
    assert.match(await chosen.textContent(), /^Default/);
    await list.getByRole('button', { name: /^Flag/ }).click();
    assert.ok(!(await list.isVisible()));
    await until(async () => (await read(other, 'scene')) === 'flag', 'the other viewer follows');
    await until(async () => (await scene_title(other)) === 'Flag');
    assert.deepEqual(other.complaints, []);
    await other.context().close();
    await until(async () => (await read(page, 'scene')) === 'flag');
    await until(async () => (await read(page, 'tick')) > 30);
    await page.locator('#view').focus();
    await page.keyboard.press('r');
    await until(async () => (await script.query('state')).tick < 30);
    await script.load('default');
    await until(async () => (await read(page, 'scene')) === 'default');
  }),
);

test('who joins a paused room of another scene reads its name in the list', bounded, async () => {
  const paused = await start_server(['--scene', 'wall', '--paused']);
  const page = await open_page(browser, paused.url);
  try {
    await until(() => page.locator('#scene-list li').count(), 'the list has come');
    assert.equal(await scene_title(page), 'Wall');
    assert.match(await page.locator('#scene-list [aria-current]').textContent(), /^Wall/);
  } finally {
    await page.context().close();
    await paused.stop();
  }
});

test('a cloth lies in the light, whichever of its sides is turned to it', bounded, async () => {
  const brightness = [];
  for (const [origin, u] of [['-0.5,1.6,0.15', '1,0,0'], ['0.5,1.6,0.15', '-1,0,0']]) {
    const options = ['--set', `cloth.origin=${origin}`, '--set', `cloth.u=${u}`];
    const wall = await start_server(['--scene', 'wall', '--paused', ...options]);
    const page = await open_page(browser, wall.url);
    try {
      await camera_at_rest(page);
      await until(() => read(page, 'fine'));
      brightness.push(await brightness_at(page, await pixel_of(page, [0, 1.1, 0.15])));
    } finally {
      await page.context().close();
      await wall.stop();
    }
  }
  // The left side is a paler dye by itself.
  const ratio = brightness[0] / brightness[1];
  assert.ok(ratio > 0.8 && ratio < 1.25, `${brightness}`);
});

test('an object is drawn where it is, and goes where Ctrl, Shift and the mouse take it', bounded, async () => {
  const moving = await start_server(['--scene', 'lift-sphere', '--paused']);
  const page = await open_page(browser, moving.url);
  const script = await moving.script();
  const round = ({ name }) => name === 'ball' || name === 'sphere';
  const ball = async () => (await read(page, 'objects')).find(round);
  const asked = async () => (await script.query('colliders')).find(round);
  try {
    await script.advance(130); // on its way up
    await until(async () => (await read(page, 'tick')) === 130);
    const { position } = await asked();
    assert.ok(position[1] > 0.4 && position[1] < 0.9, `${position}`);
    await until(async () => Math.abs((await ball()).position[1] - position[1]) < 1e-5);

    // Here the cloth does not hide it.
    await script.load('drape-sphere');
    await until(async () => (await read(page, 'scene')) === 'drape-sphere');
    await camera_at_rest(page);
    const { x, y } = await pixel_of(page, [0, 0.7, 0]);
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
    assert.deepEqual(page.complaints, []);
  } finally {
    script.close();
    await page.context().close();
    await moving.stop();
  }
});

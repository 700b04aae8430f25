import assert from 'node:assert/strict';
import { setTimeout as sleep } from 'node:timers/promises';
import test from 'node:test';
import { launch_browser, next_pictures, open_page, read, until } from './support/browser.mjs';
import { start_server } from './support/server.mjs';

// A page that is open for long. WEFT_MINUTES is how long, ten if it is not set.

const MINUTES = Number(process.env.WEFT_MINUTES ?? 10);
const LIFE = String(60 * MINUTES + 1200); // of the server [s]
const LEAK = 0.05; // by which the heap may have grown at the end; what varies is less
const SETTLING = 5e5; // that it may grow besides, as histories fill [bytes]
const SCENES = ['default', 'flag', 'table', 'two-flags', 'hard-stack', 'drape-test', 'gripper', 'fan',
  'hard-rotating-sphere', 'default'];
const ROUNDS = 3; // of the scenes
const WARM_UP = 0.2; // part of the time

/** Runs in the page before its own scripts: counts what is alive on the graphics card. */
function count_graphics() {
  const alive = {};
  window.alive = alive;
  const context = WebGL2RenderingContext.prototype;
  for (const kind of ['Buffer', 'VertexArray', 'Texture', 'Framebuffer', 'Renderbuffer', 'Program']) {
    alive[kind] = 0;
    for (const [act, step] of [['create', 1], ['delete', -1]]) {
      const own = context[act + kind];
      context[act + kind] = function (...given) {
        if (act === 'create' || given[0]) alive[kind] += step;
        return own.apply(this, given);
      };
    }
  }
}

/** What the page holds once everything that can be freed is: heap [bytes], elements and listeners. */
async function held(page) {
  const session = await page.context().newCDPSession(page);
  await session.send('Performance.enable');
  await session.send('HeapProfiler.enable');
  for (let i = 0; i < 2; i++) await session.send('HeapProfiler.collectGarbage');
  const { metrics } = await session.send('Performance.getMetrics');
  await session.detach();
  const { JSHeapUsedSize: heap, Nodes: nodes, JSEventListeners: listeners } = Object.fromEntries(
    metrics.map(({ name, value }) => [name, value]),
  );
  return { heap, nodes, listeners, graphics: await page.evaluate(() => ({ ...window.alive })) };
}

/** Points at the cloth in the middle of the picture until the ring is drawn there. */
async function point_at_cloth(page) {
  await until(async () => {
    for (const y of [120, 130, 140]) {
      await page.mouse.move(200, y); // also a still picture is drawn anew
      await next_pictures(page);
      if (await read(page, 'hovering')) return true;
    }
    return false;
  }, 'the ring is on the cloth');
}

/** Takes the cloth, and lets it go again. */
async function drag(page) {
  await point_at_cloth(page);
  await page.mouse.down();
  await until(async () => (await read(page, 'hands')).length > 0, 'a hand holds it');
  for (let i = 1; i <= 20; i++) await page.mouse.move(200 + 2 * i, 130 - i);
  await page.mouse.up();
}

test('thirty scenes and ten minutes leave memory, buffers and vertex arrays as they were', { timeout: 60_000 * MINUTES + 1_200_000 }, async () => {
  const server = await start_server(['--max-seconds', LIFE]);
  const browser = await launch_browser();
  const script = await server.script();
  try {
    const page = await open_page(browser, server.url, { width: 400, height: 300, simple: false, before: count_graphics });
    const show = async (scene) => {
      await script.load(scene);
      await until(async () => (await read(page, 'scene')) === scene, `${scene} is shown`);
      await until(async () => (await read(page, 'tick')) >= 10, 'it moves');
      await until(() => read(page, 'lit'), 'its light is whole');
    };
    const held_at_rest = async () => {
      await script.pause(); // for a fine picture, which has programs and a buffer of its own
      await until(() => read(page, 'fine'), 'the picture is a fine one');
      const now = await held(page);
      await script.resume();
      return now;
    };
    await drag(page); // the ring and the first hand's programs are made once, and stay
    const after_round = [];
    for (let round = 0; round < ROUNDS; round++) {
      for (const scene of SCENES) await show(scene);
      after_round.push(await held_at_rest());
    }
    console.log(after_round.map((each) => JSON.stringify(each)).join('\n'));
    const { graphics } = after_round[0];
    assert.ok(graphics.Buffer > 5 && graphics.VertexArray > 1, 'they are counted');
    for (const each of after_round.slice(1)) {
      assert.deepEqual(each.graphics, graphics);
      assert.ok(each.heap < after_round[0].heap * (1 + LEAK) + SETTLING, `${each.heap} bytes`);
      assert.ok(each.listeners <= after_round[0].listeners, `${each.listeners} listeners`);
    }
    const begun = await read(page, 'tick');
    const drag_for = async (minutes) => {
      for (const end = Date.now() + minutes * 60_000; Date.now() < end; await sleep(5000)) await drag(page);
      await page.mouse.move(2, 298); // beside the cloth, where there is no ring
      await until(async () => !(await read(page, 'hovering')) && (await read(page, 'hands')).length === 0);
      const now = await held_at_rest();
      console.log(`${(await read(page, 'tick')) - begun} ticks: ${JSON.stringify(now)}`);
      return now;
    };
    const start = await drag_for(MINUTES * WARM_UP); // histories fill
    await drag_for((MINUTES * (1 - WARM_UP)) / 2);
    const last = await drag_for((MINUTES * (1 - WARM_UP)) / 2);
    assert.deepEqual(last.graphics, start.graphics);
    assert.ok(last.heap < start.heap * (1 + LEAK) + SETTLING, `${start.heap} to ${last.heap} bytes`);
    assert.ok(last.nodes < start.nodes * (1 + LEAK) && last.listeners <= start.listeners, 'elements');
    assert.deepEqual(page.complaints, []);
  } finally {
    script.close();
    await browser.close();
    await server.stop();
  }
});

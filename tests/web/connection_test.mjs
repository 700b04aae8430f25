import assert from 'node:assert/strict';
import test from 'node:test';
import { next_pictures, open_page, read, until } from './support/browser.mjs';
import { browser, with_page, with_server } from './support/default_page.mjs';
import { CALM, bounded, drag_cloth } from './support/default_scene.mjs';
import { start_server } from './support/server.mjs';

// Pages that are hidden, asleep with the cloth, or cut off.

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
      const pictures = await read(page, 'pictures');
      const now = await tick();
      await until(async () => (await tick()) > now + 60);
      return (await read(page, 'tick')) === last && (await read(page, 'pictures')) === pictures;
    }, 'no frame comes in the time of sixty ticks, and none is drawn');
    await hide(false);
    const seen = await tick();
    await until(async () => (await read(page, 'tick')) > seen);
  }),
);

test('what sleeps is told, and a hand wakes it', bounded, () =>
  with_server([...CALM, '--set', 'environment.drag=20', '--set', 'sleep.after=0.5'], async (page, script) => {
    await until(() => page.locator('#asleep').isVisible(), 'the cloth sleeps');
    assert.equal(await page.locator('#asleep').textContent(), 'At rest');
    const { sleeping } = await script.query('state');
    assert.deepEqual(sleeping, { islands: 1, cloths: ['cloth'] });
    // The last frames may still have to be shown, and who has just joined gets one.
    const tick = await until(async () => {
      const last = await read(page, 'tick');
      const { tick: now } = await script.query('state');
      await until(async () => (await script.query('state')).tick > now + 120);
      await next_pictures(page);
      return (await read(page, 'tick')) === last && last;
    }, 'no frame comes in the time of 120 ticks');
    await drag_cloth(page, 0, -30);
    await until(async () => !(await page.locator('#asleep').isVisible()), 'it is awake');
    await until(async () => (await read(page, 'tick')) > tick);
    await page.mouse.up();
    await until(() => page.locator('#asleep').isVisible(), 'it sleeps again');
  }),
);

test('after the server was away the page comes back, without the hand', bounded, async () => {
  let first = await start_server(CALM);
  let second;
  const page = await open_page(browser, first.url);
  try {
    await drag_cloth(page, 0, -30);
    await until(async () => (await read(page, 'tick')) > 0);
    await first.stop('SIGKILL');
    first = null;
    await until(async () => (await read(page, 'phase')) !== 'open');
    assert.equal(await read(page, 'input'), 'idle');
    await until(async () => (await read(page, 'hands')).length === 0);
    await page.mouse.up();
    second = await start_server([...CALM, '--paused'], Number(new URL(page.url()).port));
    await until(async () => (await read(page, 'phase')) === 'open', 'it is connected again');
    await until(async () => (await read(page, 'tick')) === 0, 'it shows the cloth of the new server');
    const script = await second.script();
    await script.resume();
    await until(async () => (await read(page, 'tick')) > 20);
    await drag_cloth(page, 0, -30);
    await until(() => script.last.grabs.length === 1, 'the cloth can be taken again');
    script.close();
    // The browser itself tells of each attempt that failed, and of each question why.
    const own = page.complaints.filter(
      (text) => !/^(WebSocket connection to|Failed to load resource: net::ERR_CONNECTION_REFUSED)/.test(text),
    );
    assert.deepEqual(own, []);
  } finally {
    await page.context().close();
    await first?.stop();
    await second?.stop();
  }
});

test('a loss of the server is told once, and its return once, however many attempts fail', bounded, async () => {
  let own = await start_server(CALM);
  const page = await open_page(browser, own.url);
  try {
    await page.evaluate(() => {
      const text = document.getElementById('connection-text');
      window.told = [];
      new MutationObserver(() => window.told.push(text.textContent)).observe(text, { childList: true });
    });
    await own.stop('SIGKILL');
    own = null;
    // The browser itself tells of each.
    const failed = () => page.complaints.filter((text) => text.startsWith('WebSocket connection to')).length;
    await until(() => failed() >= 3, 'attempts fail');
    assert.deepEqual(await page.evaluate(() => window.told), ['Reconnecting']);
    own = await start_server(CALM, Number(new URL(page.url()).port));
    await until(async () => (await read(page, 'phase')) === 'open', 'it is connected again');
    assert.deepEqual(await page.evaluate(() => window.told), ['Reconnecting', 'Connected']);
  } finally {
    await page.context().close();
    await own?.stop();
  }
});

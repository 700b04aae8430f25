import assert from 'node:assert/strict';
import test from 'node:test';
import { open_page, read, until } from './support/browser.mjs';
import { browser, server } from './support/default_page.mjs';
import { CALM, bounded, drag_cloth } from './support/default_scene.mjs';
import { PASSES_UPGRADES, forward_to, free_port, start_proxy } from './support/forward.mjs';
import { start_server } from './support/server.mjs';

// The page through what stands between it and its server, and its words where it is not let in.

const NAME = 'weft.example'; // which for the tests' browser is this machine

/** Opens a page that may be refused. */
async function open_raw(url) {
  const context = await browser.newContext({ ignoreHTTPSErrors: true });
  const page = await context.newPage();
  await page.goto(url);
  return page;
}

const shown = (page, id) => page.locator(`#${id}`).textContent();

/** Waits for the words of a refusal. */
async function refusal(page, message) {
  await until(() => page.locator('#refusal').isVisible(), 'the refusal is shown');
  await until(async () => (await shown(page, 'refusal-message')) === message, message);
  assert.equal(await shown(page, 'connection-text'), 'Refused');
  return shown(page, 'refusal-hint');
}

test('the page works through a forwarded port of another number', bounded, async () => {
  const front = await forward_to(server.port);
  try {
    assert.notEqual(front.port, server.port);
    for (const host of ['localhost', '127.0.0.1']) {
      const page = await open_page(browser, `http://${host}:${front.port}/`);
      await drag_cloth(page, 0, -30);
      await page.mouse.up();
      assert.deepEqual(page.complaints, []);
      await page.context().close();
    }
  } finally {
    await front.stop();
  }
});

for (const [proxy, host] of [
  ['keeps the Host', '$http_host'],
  ['sets a Host of its own', '$proxy_host'],
]) {
  test(`the page works through nginx with TLS that ${proxy}`, bounded, async () => {
    const port = await free_port();
    const origin = `https://${NAME}:${port}`;
    const own = await start_server([...CALM, '--allow-origin', origin]);
    const front = await start_proxy(own.port, port, PASSES_UPGRADES.replace('$http_host', host));
    try {
      const page = await open_page(browser, `${origin}/`);
      assert.equal(await page.evaluate(() => window.isSecureContext), true);
      await drag_cloth(page, 0, -30);
      await page.mouse.up();
      assert.deepEqual(page.complaints, []);
      await page.context().close();
    } finally {
      await front.stop();
      await own.stop();
    }
  });
}

test('a page that is not let in says why, and what helps, until it is let in', bounded, async () => {
  const port = await free_port();
  const origin = `https://${NAME}:${port}`;
  let own = await start_server(CALM);
  // A proxy that hides the name, so that the page itself comes through.
  const front = await start_proxy(own.port, port, PASSES_UPGRADES.replace('$http_host', '$proxy_host'));
  try {
    const page = await open_raw(`${origin}/`);
    const hint = await refusal(page, `Pages of ${origin} may not connect.`);
    assert.equal(hint, `Start the server with --allow-origin ${origin}.`);
    const { port: same } = own;
    await own.stop();
    own = await start_server([...CALM, '--allow-origin', origin], same);
    await until(async () => (await read(page, 'phase')) === 'open', 'it is let in');
    assert.equal(await page.locator('#refusal').isVisible(), false);
    assert.equal(await shown(page, 'connection-text'), 'Connected');
    await page.context().close();
  } finally {
    await front.stop();
    await own.stop();
  }
});

test('a name that is not the server’s is refused with the names that are', bounded, async () => {
  const context = await browser.newContext();
  const page = await context.newPage();
  const answer = await page.goto(`http://${NAME}:${server.port}/`);
  assert.equal(answer.status(), 403);
  const { error } = await answer.json();
  assert.equal(error.value, NAME);
  assert.ok(error.offered.includes('localhost'));
  assert.match(error.hint, /--allow-origin http:\/\/weft\.example/);
  await context.close();
});

test('a page of a full server says so, and comes in when there is room', bounded, async () => {
  const own = await start_server([...CALM, '--max-viewers', '1']);
  const script = await own.script();
  try {
    const page = await open_raw(own.url);
    assert.equal(await refusal(page, 'At most 1 viewers.'), 'Try again later.');
    script.close();
    await until(async () => (await read(page, 'phase')) === 'open', 'there is room');
    assert.equal(await page.locator('#refusal').isVisible(), false);
    await page.context().close();
  } finally {
    script.close();
    await own.stop();
  }
});

test('behind a proxy that passes no upgrade the page names the proxy', bounded, async () => {
  const port = await free_port();
  const front = await start_proxy(server.port, port, 'proxy_set_header Host $http_host;');
  try {
    const page = await open_raw(`https://127.0.0.1:${port}/`);
    const hint = await refusal(page, 'The server answers, but its socket does not open.');
    assert.equal(hint, 'A proxy in between has to pass WebSocket upgrades on.');
    await page.context().close();
  } finally {
    await front.stop();
  }
});

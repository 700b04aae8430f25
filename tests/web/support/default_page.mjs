import assert from 'node:assert/strict';
import { after, before } from 'node:test';
import { launch_browser, open_page } from './browser.mjs';
import { CALM } from './default_scene.mjs';
import { start_server } from './server.mjs';

// What most files of tests of the page begin with: a browser, and a server with the default scene.

export let browser;
export let server;
before(async () => {
  browser = await launch_browser();
  server = await start_server(CALM);
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

/**
 * Gives a test a page and a script at the default scene's start, and sees them off.
 * @param options of the page; paused: time stands still, where no hand is lost, however slowly its page draws
 */
export async function with_page({ paused = false, ...options }, act) {
  const script = await server.script();
  await script.release({ all: true });
  await (paused ? script.pause() : script.resume());
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

/** Gives a test a page and a script at a server of its own, and sees all three off. */
export async function with_server(options, act, page_options = {}) {
  const own = await start_server(options);
  const script = await own.script();
  const page = await open_page(browser, own.url, page_options);
  try {
    await act(page, script);
    assert.deepEqual(page.complaints, []);
  } finally {
    script.close();
    await page.context().close();
    await own.stop();
  }
}

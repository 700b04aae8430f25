import assert from 'node:assert/strict';
import { setTimeout as sleep } from 'node:timers/promises';
import { make_pages_late } from './late.mjs';
import { require_package } from './packages.mjs';

const { chromium } = require_package('playwright-core');

const SELDOM = 50; // between pictures that are not judged by their looks, which leaves a core for another test [ms]
const LONGEST_WAIT = 120_000; // a bound for what has gone wrong, not a demand on speed [ms]

export function launch_browser() {
  return chromium.launch({
    executablePath: '/usr/bin/chromium',
    args: [
      '--no-sandbox',
      '--use-gl=angle',
      '--use-angle=swiftshader',
      '--enable-unsafe-swiftshader',
      '--ignore-gpu-blocklist',
      '--disable-background-networking',
      '--disable-component-update',
      '--disable-sync',
      '--no-first-run',
      '--disable-quic',
      '--host-resolver-rules=MAP weft.example 127.0.0.1',
    ],
  });
}

/** Runs in a page before its own scripts. @param interval between pictures, at least [ms] */
function draw_seldom(interval) {
  const next_picture = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (draw) => setTimeout(() => next_picture(draw), interval);
}

/**
 * Opens the page and waits until it shows the cloth. What it complains of is kept in `complaints`.
 * @param {import('playwright-core').Browser} browser
 * @param {string} url
 * @param {{width?: number, height?: number, touch?: boolean, name?: string, dark?: boolean,
 *   view?: number[], simple?: boolean, interval?: number, visited?: boolean, before?: () => void}} [options]
 *     view: target, direction and radius of the first view; simple: in simple light, which software
 *     draws several times as fast, as all is that is not judged by its looks; interval: between
 *     pictures, at least [ms]; visited: not for the first time;
 *     before: runs in the page before its own scripts
 */
export async function open_page(browser, url, options = {}) {
  const { width = 560, height = 420, touch = false, name = '', dark = false } = options;
  const { view, simple = true, interval = simple ? SELDOM : 0, visited = false, before } = options;
  const context = await browser.newContext({
    viewport: { width, height },
    hasTouch: touch,
    colorScheme: dark ? 'dark' : 'light',
    ignoreHTTPSErrors: true, // of a certificate that a test has made
  });
  context.setDefaultTimeout(LONGEST_WAIT);
  if (visited) await context.addInitScript(() => localStorage.setItem('weft-taken', 'yes'));
  if (before) await context.addInitScript(before);
  if (interval > 0) await context.addInitScript(draw_seldom, interval);
  await make_pages_late(context);
  const page = await context.newPage();
  const complaints = [];
  page.on('console', (message) => {
    if (message.type() === 'error') complaints.push(message.text());
  });
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('request', (request) => {
    const { origin, protocol } = new URL(request.url());
    if (protocol !== 'data:' && origin !== new URL(url).origin) complaints.push(request.url());
  });
  page.on('response', (response) => {
    if (response.status() >= 400) complaints.push(`${response.status()} ${response.url()}`);
  });
  const address = new URL(url);
  for (const [key, value] of Object.entries({ name, view, light: simple && 'simple' }))
    if (value) address.searchParams.set(key, String(value));
  await page.goto(address.href);
  const opened = Object.assign(page, { complaints });
  await until(() => page.evaluate(() => window.weft.phase === 'open' && window.weft.tick >= 0));
  return opened;
}

/**
 * Waits until something holds and returns it.
 * @template Value
 * @param {() => Promise<Value> | Value} condition
 * @param {string} [what] for the failure
 * @param {number} [longest] wait [ms]
 */
export async function until(condition, what = condition.toString(), longest = LONGEST_WAIT) {
  const end = Date.now() + longest;
  for (;;) {
    const value = await condition();
    if (value) return value;
    assert.ok(Date.now() < end, `never came true: ${what}`);
    await sleep(40);
  }
}

/** Reads one thing of the page's probe. */
export const read = (page, name) => page.evaluate((key) => window.weft[key], name);

/** Waits until the server has done all that the page has asked for: what it did not ask by then, it never will. */
export const done = (page) => page.evaluate(() => window.weft.done());

/** Waits until the camera rests. */
export async function camera_at_rest(page) {
  let last = '';
  await until(async () => {
    const now = JSON.stringify(await read(page, 'camera'));
    const same = now === last;
    last = now;
    await next_pictures(page);
    return same;
  }, 'the camera rests');
  return read(page, 'camera');
}

/** Lets the page draw twice, if there is anything to draw. */
export function next_pictures(page) {
  return page.evaluate(
    () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))),
  );
}

/** Pixel of a point [m] as the page's camera sees it. */
export async function pixel_of(page, point) {
  const { camera, size } = await page.evaluate(() => ({ camera: weft.camera, size: weft.size }));
  return project(camera, size, point);
}

/**
 * @param {{view: number[], projection: number[]}} camera matrices in columns
 * @param {{width: number, height: number}} size [pixels]
 * @param {ArrayLike<number>} point [m]
 * @returns {{x: number, y: number, depth: number}} pixel, and depth that is linear on the screen
 */
export function project({ view, projection }, { width, height }, point) {
  const transform = (matrix, [x, y, z, w]) =>
    [0, 1, 2, 3].map(
      (row) => matrix[row] * x + matrix[row + 4] * y + matrix[row + 8] * z + matrix[row + 12] * w,
    );
  const eye = transform(view, [point[0], point[1], point[2], 1]);
  const [x, y, z, w] = transform(projection, eye);
  return { x: ((x / w + 1) / 2) * width, y: ((1 - y / w) / 2) * height, depth: z / w };
}

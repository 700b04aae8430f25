import { until } from './browser.mjs';

const THROTTLING = 6; // factor by which the page's thread is slowed
const LIT = 'the light is whole and drawn'; // a mark in the trace
const TRACED = ['disabled-by-default-devtools.timeline', 'blink.user_timing'];

/**
 * Loads the page on a slow machine, and tells how it started.
 * @param {import('playwright-core').Browser} browser
 * @param {string} url
 * @returns {Promise<{sockets: number, phases: string[], simple: boolean}>} sockets that were
 *     opened, the connection's phases, and whether a cloth was drawn before its light was whole
 */
export async function slow_start(browser, url) {
  return start(browser, async (page) => {
    const session = await page.context().newCDPSession(page);
    await session.send('Emulation.setCPUThrottlingRate', { rate: THROTTLING });
    return load(page, url);
  });
}

/**
 * Loads the page and measures the tasks of its thread until the light is whole.
 * @returns {Promise<{tasks: number[], simple: boolean}>} their CPU times, longest first [ms]
 */
export async function traced_start(browser, url) {
  return start(browser, async (page) => {
    await browser.startTracing(page, { categories: TRACED });
    const { simple } = await load(page, url);
    await page.evaluate((mark) => performance.mark(mark), LIT);
    const { traceEvents } = JSON.parse((await browser.stopTracing()).toString());
    const { pid, tid } = traceEvents.find(({ name }) => name === LIT);
    const tasks = traceEvents.filter(
      (each) => each.name === 'RunTask' && each.pid === pid && each.tid === tid && each.tdur > 0,
    );
    return { simple, tasks: tasks.map(({ tdur }) => tdur / 1000).sort((one, other) => other - one) };
  });
}

async function start(browser, act) {
  const context = await browser.newContext({ viewport: { width: 400, height: 300 } });
  const page = await context.newPage();
  await page.addInitScript(watch);
  const found = await act(page);
  await context.close();
  return found;
}

async function load(page, url) {
  await page.goto(url);
  const drawn = () => window.weft?.lit && window.weft.pictures > window.seen.pictures;
  await until(() => page.evaluate(drawn), LIT);
  return page.evaluate(() => window.seen);
}

/** Runs in the page before its own scripts. */
function watch() {
  const seen = { sockets: 0, phases: [], simple: false, pictures: Infinity };
  window.seen = seen;
  window.WebSocket = class extends WebSocket {
    constructor(...given) {
      super(...given);
      seen.sockets += 1;
    }
  };
  const look = () => {
    requestAnimationFrame(look);
    if (!window.weft) return;
    const { phase, pictures, tick, lit } = window.weft;
    if (seen.phases.at(-1) !== phase) seen.phases.push(phase);
    seen.simple ||= pictures > 0 && tick >= 0 && !lit;
    if (lit) seen.pictures = Math.min(seen.pictures, pictures);
  };
  look();
}

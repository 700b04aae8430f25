import { until } from './browser.mjs';

const THROTTLING = 6; // factor by which the page's thread is slowed

/**
 * Loads the page on a slow machine, and tells how it started.
 * @param {import('playwright-core').Browser} browser
 * @param {string} url
 * @returns {Promise<{sockets: number, phases: string[], simple: boolean}>} sockets that were
 *     opened, the connection's phases, and whether a cloth was drawn before its light was whole
 */
export async function slow_start(browser, url) {
  const context = await browser.newContext({ viewport: { width: 400, height: 300 } });
  const page = await context.newPage();
  const session = await context.newCDPSession(page);
  await session.send('Emulation.setCPUThrottlingRate', { rate: THROTTLING });
  await page.addInitScript(watch);
  await page.goto(url);
  await until(() => page.evaluate(() => window.weft?.lit), 'the light is whole');
  const seen = await page.evaluate(() => window.seen);
  await context.close();
  return seen;
}

/** Runs in the page before its own scripts. */
function watch() {
  const seen = { sockets: 0, phases: [], simple: false };
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
  };
  look();
}

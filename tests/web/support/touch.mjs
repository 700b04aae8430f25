import { import_page_module } from './page_module.mjs';

const { LONG_PRESS } = await import_page_module('hold/pointer');

/**
 * Fingers on a page, by emulation: each has a number and a pixel. An event of the browser's protocol
 * names the fingers that change.
 */
export async function fingers_on(page) {
  const session = await page.context().newCDPSession(page);
  const down = new Map();
  const send = (type, ids) =>
    session.send('Input.dispatchTouchEvent', {
      type,
      touchPoints: ids.map((id) => ({ ...down.get(id), id })),
    });
  return {
    /** @param {number} id @param {{x: number, y: number}} at */
    async press(id, { x, y }) {
      down.set(id, { x, y });
      await send('touchStart', [id]);
    },
    /** Moves fingers in a few steps. @param {Record<number, [number, number]>} ways in pixels */
    async move(ways, steps = 4) {
      const ids = Object.keys(ways).map(Number);
      for (let n = 0; n < steps; n++) {
        for (const id of ids) {
          const { x, y } = down.get(id);
          down.set(id, { x: x + ways[id][0] / steps, y: y + ways[id][1] / steps });
        }
        await send('touchMove', ids);
      }
    },
    /** @param {number} id */
    async lift(id) {
      await send('touchEnd', [id]);
      down.delete(id);
    },
  };
}

/** Lets the test end the timers of long presses, so that it does not matter how slowly things go. */
export function hold_long_presses(page) {
  return page.evaluate((long_press) => {
    const { setTimeout, clearTimeout } = window;
    const pressed = (window.long_presses = new Map());
    let count = 0;
    window.setTimeout = (act, delay, ...rest) => {
      if (delay !== long_press) return setTimeout(act, delay, ...rest);
      pressed.set(--count, act);
      return count;
    };
    window.clearTimeout = (id) => pressed.delete(id) || clearTimeout(id);
  }, LONG_PRESS);
}

/** How many fingers rest where a long press does something. */
export const long_presses = (page) => page.evaluate(() => window.long_presses.size);

export const end_long_presses = (page) =>
  page.evaluate(() => {
    const acts = [...window.long_presses.values()];
    window.long_presses.clear();
    for (const act of acts) act();
  });

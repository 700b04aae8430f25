// Measures how long after the pointer goes down on the cloth a picture is drawn whose frame has that
// hand, and after a movement of the hand one whose frame has that movement, in the page without a
// screen. Where the processor draws, and is busy besides, pictures are late for that reason alone.
// usage: WEFT_PROGRAM=build/weft node tests/web/pick_to_picture.mjs [PICKS]
import { setTimeout as sleep } from 'node:timers/promises';
import { launch_browser, open_page, pixel_of, read, until } from './support/browser.mjs';
import { numbers } from './support/made_up.mjs';
import { start_server } from './support/server.mjs';

const picks = Number(process.argv[2] ?? 200);
const TICK = 1000 / 60; // [ms]
const LONGEST_PAUSE = 60; // before a pick, so that picks come at any phase of ticks and pictures [ms]
const MOVES = 4; // of each hand
const SIZE = { width: 320, height: 240 }; // where the processor draws, larger pictures measure that
const BAR = 20; // beyond the tick [ms]

/** Runs in the page before its own scripts: notes when the pointer goes down and when that is seen. */
function watch() {
  const seen = { picks: [], moves: [], down: null };
  window.seen = seen;
  addEventListener('pointerdown', ({ timeStamp }) => (seen.down = timeStamp), true);
  // The page's own callback of a picture was asked for earlier, so that it has drawn by now.
  const look = () => {
    requestAnimationFrame(look);
    if (seen.down === null || !window.weft?.hands.some(({ own, force }) => own && force !== null)) return;
    seen.picks.push(performance.now() - seen.down);
    seen.down = null;
  };
  requestAnimationFrame(look);
  addEventListener('DOMContentLoaded', () => {
    const latency = document.getElementById('latency');
    const note = () => Number.isFinite(Number(latency.textContent)) && seen.moves.push(Number(latency.textContent));
    new MutationObserver(note).observe(latency, { childList: true, characterData: true, subtree: true });
  });
}

function print(what, times) {
  const sorted = [...times].sort((a, b) => a - b);
  const at = (part) => sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))];
  const [p50, p95] = [at(0.5), at(0.95)];
  const beyond = p95 - TICK;
  console.log(`${what}: ${times.length} times, p50 ${p50.toFixed(1)} ms, p95 ${p95.toFixed(1)} ms, ` +
    `${beyond.toFixed(1)} ms beyond a tick (bar ${BAR}: ${beyond <= BAR ? 'held' : 'missed'})`);
}

const server = await start_server(['--scene', 'wall']);
const browser = await launch_browser();
const random = numbers(29);
try {
  const page = await open_page(browser, server.url, { ...SIZE, simple: false, visited: true, before: watch });
  await until(() => read(page, 'lit'), 'the light is whole');
  await sleep(1000); // quality has settled
  for (let pick = 0; pick < picks; pick++) {
    const positions = await read(page, 'positions');
    const middle = 3 * Math.floor(positions.length / 6);
    const { x, y } = await pixel_of(page, positions.slice(middle, middle + 3));
    await page.mouse.move(x, y);
    await sleep(random() * LONGEST_PAUSE);
    await page.mouse.down();
    await until(() => page.evaluate((wanted) => window.seen.picks.length === wanted, pick + 1), 'the hand is seen');
    for (let move = 1; move <= MOVES; move++) {
      await page.mouse.move(x + move, y - move);
      await sleep(LONGEST_PAUSE);
    }
    await page.mouse.up();
    await until(async () => (await read(page, 'hands')).length === 0, 'it has let go');
  }
  const { picks: of_picks, moves } = await page.evaluate(() => window.seen);
  print('from taking hold', of_picks);
  print('from movements, as the page tells', moves);
  if (page.complaints.length) throw new Error(page.complaints.join('; '));
} finally {
  await browser.close();
  await server.stop();
}

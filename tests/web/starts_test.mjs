import assert from 'node:assert/strict';
import test from 'node:test';
import { launch_browser } from './support/browser.mjs';
import { start_server } from './support/server.mjs';
import { slow_start, traced_start } from './support/starts.mjs';

const TIMES = 20;
const LONGEST_TASK = 200; // CPU time [ms]

test('twenty of twenty loads on a machine six times slower keep their first connection', { timeout: 1_500_000 }, async () => {
  const server = await start_server(['--max-seconds', '1800']);
  const starts = [];
  try {
    for (let i = 0; i < TIMES; i++) {
      // A browser of its own each time, which has no shaders of the last one.
      const browser = await launch_browser();
      const start = await slow_start(browser, server.url).finally(() => browser.close());
      starts.push(start);
      console.log(`${i + 1}: ${start.sockets} sockets, ${start.phases.join(' ')}`);
    }
  } finally {
    await server.stop();
  }
  const kept = starts.filter(({ sockets, phases }) => sockets === 1 && !phases.includes('waiting'));
  assert.equal(kept.length, TIMES);
  assert.ok(starts.every(({ simple }) => simple), 'each drew a simply lit cloth first');
});

test('no task of a start takes more than 200 ms of CPU time', { timeout: 300_000 }, async () => {
  const server = await start_server();
  const browser = await launch_browser();
  const { tasks, simple } = await traced_start(browser, server.url);
  await browser.close();
  await server.stop();
  assert.ok(simple, 'the light follows the first picture');
  assert.ok(tasks.length > 50 && tasks[0] > 1, `${tasks.length} tasks`);
  const longest = tasks.slice(0, 5).map((time) => time.toFixed(1)).join(', ');
  console.log(`longest tasks: ${longest} ms of CPU time`);
  assert.ok(tasks[0] < LONGEST_TASK, `${longest} ms`);
});

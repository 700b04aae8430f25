// Loads the page again and again on a machine that is slowed six times, and says how often its first
// connection was kept.
// usage: WEFT_PROGRAM=build/weft node tests/web/starts.mjs [TIMES]
import { launch_browser } from './support/browser.mjs';
import { start_server } from './support/server.mjs';
import { slow_start } from './support/starts.mjs';

const times = Number(process.argv[2] ?? 20);
const server = await start_server();
let kept = 0;
try {
  for (let i = 0; i < times; i++) {
    // A browser of its own each time, which has no shaders of the last one.
    const browser = await launch_browser();
    const { sockets, phases, simple } = await slow_start(browser, server.url);
    await browser.close();
    if (sockets === 1) kept += 1;
    console.log(`${i + 1}: ${sockets} sockets, ${phases.join(' ')}${simple ? ', first simply lit' : ''}`);
  }
} finally {
  await server.stop();
}
console.log(`${kept} of ${times} loads kept their first connection`);
process.exitCode = kept === times ? 0 : 1;

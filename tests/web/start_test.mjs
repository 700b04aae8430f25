import assert from 'node:assert/strict';
import test from 'node:test';
import { browser, server } from './support/default_page.mjs';
import { bounded } from './support/default_scene.mjs';
import { slow_start } from './support/starts.mjs';

// What the page does first.

test('a slow start keeps its first connection, and first draws a simply lit cloth', bounded, async () => {
  const { sockets, phases, simple } = await slow_start(browser, server.url);
  assert.equal(sockets, 1, `${phases}`);
  assert.ok(!phases.includes('waiting'), `${phases}`);
  assert.ok(simple, 'a cloth was drawn before its light was whole');
});

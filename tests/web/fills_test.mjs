import assert from 'node:assert/strict';
import test from 'node:test';
import { launch_browser } from './support/browser.mjs';
import { first_view, scene_names } from './support/first_views.mjs';

const LEAST = 0.2; // of the picture

test('of each scene of one cloth, cloth is 20 % of the first view', { timeout: 2_300_000 }, async () => {
  const browser = await launch_browser();
  const fills = new Map();
  try {
    for (const scene of scene_names()) {
      const { cloths, fill, complaints } = await first_view(browser, scene);
      assert.deepEqual(complaints, [], scene);
      if (cloths === 1) fills.set(scene, fill);
      console.log(`${scene}: ${(fill * 100).toFixed(1)} % of ${cloths} cloths`);
    }
  } finally {
    await browser.close();
  }
  assert.ok(fills.size > 30, `${fills.size} scenes of one cloth`);
  for (const [scene, fill] of fills) {
    assert.ok(fill >= LEAST, `${scene}: ${(fill * 100).toFixed(1)} %`);
  }
});

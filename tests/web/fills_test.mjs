import assert from 'node:assert/strict';
import test from 'node:test';
import { launch_browser } from './support/browser.mjs';
import { first_view, scene_names } from './support/first_views.mjs';

const LEAST = 0.2; // of the picture
const SEVERAL = ['two-flags']; // cloths side by side, which are to fill as much together
const EDGE = 0.04; // of the picture, in which no jaw of a gripper is

test('cloth is 20 % of the first view of each scene of one cloth and of two flags, and jaws are within it', { timeout: 2_300_000 }, async () => {
  const browser = await launch_browser();
  const fills = new Map();
  try {
    for (const scene of scene_names()) {
      const { cloths, fill, jaws, complaints } = await first_view(browser, scene);
      assert.deepEqual(complaints, [], scene);
      if (cloths === 1 || SEVERAL.includes(scene)) fills.set(scene, fill);
      const inside = jaws.every(({ x, y }) => Math.min(x, y, 1 - x, 1 - y) > EDGE);
      assert.ok(inside, `${scene}: jaws at ${JSON.stringify(jaws)}`);
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

import assert from 'node:assert/strict';
import { mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test, { after, before } from 'node:test';
import { figures_of, print_figures } from './figures.mjs';
import { difference } from './support/figures.mjs';

// The figures of cloth that `./dev pictures --figures` prints, but for first views.

const TOLD_APART = 20; // in CIELAB
const LEAST_SPAN = 40; // of luma, 0 to 255

let figures;
before(async () => {
  const folder = await mkdtemp(join(tmpdir(), 'weft-looks-'));
  figures = await figures_of(folder, { views: [] });
  await rm(folder, { recursive: true });
  print_figures(figures);
  assert.deepEqual(figures.complaints, []);
}, { timeout: 1_200_000 });
after(() => (figures = null));

/** All pairs of fabrics, with what was found of each. */
function pairs() {
  const all = [...figures.fabrics];
  return all.flatMap(([name, found], k) => all.slice(0, k).map(([other, its]) => [`${name}, ${other}`, found, its]));
}

test('six fabrics differ in mean colour by 20 in CIELAB, each from each other', () => {
  assert.equal(figures.fabrics.size, 6);
  for (const [names, one, other] of pairs()) {
    assert.ok(difference(one.lab, other.lab) >= TOLD_APART, `${names}: ${one.lab} and ${other.lab}`);
  }
});

test('threads or grain of six fabrics are at least 10 % apart in their spacing', () => {
  for (const [names, one, other] of pairs()) {
    const [finer, coarser] = [one.spacing, other.spacing].sort((a, b) => a - b);
    assert.ok(coarser >= 1.1 * finer, `${names}: ${finer} and ${coarser} mm`);
  }
});

test('dyed alike, smooth fabrics have a highlight and rough ones less, and no two the same', () => {
  const contrast = (name) => figures.fabrics.get(name).highlight;
  for (const smooth of ['silk', 'leather']) {
    for (const rough of ['cotton', 'denim']) {
      assert.ok(contrast(smooth) > 1.25 * contrast(rough), `${smooth} ${contrast(smooth)}, ${rough} ${contrast(rough)}`);
    }
  }
  for (const [names, { highlight: one }, { highlight: other }] of pairs()) {
    assert.ok(Math.abs(one - other) > 0.02, `${names}: ${one} and ${other}`);
  }
});

test('cloths that share a scene differ in mean colour by 20 in CIELAB', () => {
  for (const [scene, { cloths, difference: least }] of figures.scenes) {
    assert.ok(cloths > 1 && least >= TOLD_APART, `${scene}: ${least} of ${cloths}`);
  }
});

test('from behind, without weave and hem, lumas of folds span 40 of 255 from p5 to p95', () => {
  assert.deepEqual([...figures.behind.keys()], ['light', 'dark']);
  for (const [theme, found] of figures.behind) {
    assert.ok(found.span >= LEAST_SPAN, `${theme}: ${JSON.stringify(found)}`);
  }
});

import assert from 'node:assert/strict';
import test from 'node:test';
import { open_page, until } from './support/browser.mjs';
import { browser, with_server } from './support/default_page.mjs';
import { bounded } from './support/default_scene.mjs';
import { import_page_module } from './support/page_module.mjs';

// What the page says of the promise that nothing passes through, in lines that stay.

const { crossings_text, guarantee_text, reasons_text } = await import_page_module('panel/guarantee');

/** All words of one moment. */
const says = (page) =>
  page.evaluate(() => {
    const words = (id) => document.getElementById(id).textContent;
    const { state } = document.getElementById('guarantee').dataset;
    return { guarantee: words('guarantee-text'), reasons: words('reasons'), state, crossings: words('crossings') };
  });

test('each state of the guarantee and each count has its words', () => {
  const guarantee = { state: 'held', covers: ['objects', 'cloth'], pairs: 0, reasons: [] };
  assert.equal(guarantee_text(guarantee), 'Cloth passes through nothing');
  assert.equal(reasons_text(guarantee), '');
  const objects = { ...guarantee, covers: ['objects'] };
  assert.equal(guarantee_text(objects), 'Cloth passes through no object');
  const bad = { ...guarantee, state: 'bad_start', pairs: 12, reasons: ['a started inside b'] };
  assert.equal(guarantee_text(bad), 'It began tangled, and comes free');
  assert.equal(reasons_text(bad), 'Not promised for 12 pairs: a started inside b');
  const broken = { ...guarantee, state: 'void', reasons: ['b was forced through'] };
  assert.equal(guarantee_text(broken), 'Something was forced through the cloth');
  assert.equal(reasons_text(broken), 'Not promised: b was forced through');
  const none = { ...guarantee, state: 'none', covers: [] };
  assert.equal(guarantee_text(none), 'Nothing keeps this cloth from passing through');
  const count = (count, smallest_gap) => crossings_text({ count, tick: 60, smallest_gap });
  assert.equal(count(0, 0.00312), '0 crossings, smallest gap 3.1 mm');
  assert.equal(count(0, 0.000512), '0 crossings, smallest gap 0.51 mm');
  assert.equal(count(0, -0.183), '0 crossings, up to 183.0 mm inside an object');
  assert.equal(count(1, null), '1 crossing, nothing near');
});

test('the page shows that nothing passes through, and the smallest gap in millimetres', bounded, () =>
  with_server(['--scene', 'drape-sphere', '--paused'], async (page, script) => {
    await until(async () => (await says(page)).crossings === '0 crossings, nothing near');
    await script.advance(120);
    const { guarantee, state, crossings } = await until(async () => {
      const said = await says(page);
      return /smallest gap \d+\.\d+ mm/.test(said.crossings) && said;
    }, 'a gap is told');
    assert.deepEqual([guarantee, state], ['Cloth passes through nothing', 'held']);
    assert.match(crossings, /^0 crossings, /);
    assert.ok(await page.locator('#guarantee').isVisible());
    assert.ok(await page.locator('#crossings').isVisible());
  }),
);

test('a bad start is on the page of who comes late, until it is out; a voided promise until reset', bounded, () =>
  with_server(['--scene', 'hard-start-inside', '--paused'], async (page, script) => {
    const bad = async (shown) => {
      const said = await says(shown);
      return /^Not promised for \d+ pairs: cloth started inside ball$/.test(said.reasons) && said;
    };
    const { crossings } = await until(() => bad(page), 'before the first tick');
    assert.match(crossings, /^\d+ crossings?, /);
    await script.advance(5);
    const late = await open_page(browser, new URL('/', page.url()).href);
    await until(() => bad(late), 'who comes late knows');
    await late.context().close();
    await script.advance(240);
    const becomes = (state) =>
      until(async () => {
        const said = await says(page);
        return said.state === state && said;
      }, `the promise is ${state}`);
    assert.equal((await becomes('held')).guarantee, 'Cloth passes through nothing');
    await script.pin({ particle: 544, radius: 2 });
    await script.move('ball', { position: [0, 2, 0], speed: 20, force: true });
    await script.advance(60);
    assert.match((await becomes('void')).reasons, /: ball was forced/);
    await script.reset();
    await until(() => bad(page));
  }),
);

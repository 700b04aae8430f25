import assert from 'node:assert/strict';
import { once } from 'node:events';
import { readdir, stat } from 'node:fs/promises';
import { get } from 'node:http';
import test from 'node:test';
import { read, until } from './support/browser.mjs';
import { server, with_page } from './support/default_page.mjs';
import { bounded } from './support/default_scene.mjs';
import { import_page_module } from './support/page_module.mjs';

// The browser of scenes: groups, search, keys and pictures.

const { grouped, matches } = await import_page_module('panel/scene_groups');

const LARGEST_PICTURE = 4096; // [bytes]
const pictures = new URL('../../web/picture/scenes/', import.meta.url);
const known = async () => (await (await fetch(new URL('api/v1/scenes', server.url))).json()).scenes;

test('each scene is in one group, and words of a search begin words of title or description', async () => {
  const scenes = await known();
  const groups = grouped(scenes);
  const listed = groups.flatMap(({ scenes: members }) => members.map(({ name }) => name));
  assert.deepEqual(listed.toSorted(), scenes.map(({ name }) => name).toSorted());
  assert.deepEqual(
    groups.map(({ title }) => title),
    ['Everyday', 'Fabrics', 'Hands and machines', 'Laboratory', 'The seed’s paper', 'Hard cases'],
  );
  assert.equal(groups[0].scenes[0].name, 'default');
  const scene = { name: 'two-flags', description: 'Silk and denim on two poles.' };
  for (const found of ['', 'flag', 'two fl', 'DENIM', 'silk two']) assert.ok(matches(scene, found), found);
  for (const missed of ['lags', 'silk wool', 'x']) assert.ok(!matches(scene, missed), missed);
});

test('pictures are of scenes that there are, and at most 4 kB each', async () => {
  const names = new Set((await known()).map(({ name }) => `${name}.jpg`));
  const files = await readdir(pictures);
  assert.ok(files.length > 0);
  for (const file of files) {
    assert.ok(names.has(file), file);
    assert.ok((await stat(new URL(file, pictures))).size <= LARGEST_PICTURE, file);
  }
});

test('typing filters the scenes, arrows go through them, and Enter loads one', bounded, () =>
  with_page({ width: 900, height: 600 }, async (page, script) => {
    const asked = [];
    page.on('request', (request) => asked.push(new URL(request.url()).pathname));
    await page.locator('#view').focus();
    await page.keyboard.press('l');
    const dialog = page.getByRole('dialog', { name: 'Scenes' });
    const choices = dialog.getByRole('listitem').getByRole('button');
    await until(async () => (await choices.count()) === (await known()).length);
    const focused = () => page.evaluate(() => document.activeElement.querySelector('b')?.textContent);
    await page.keyboard.press('ArrowDown');
    assert.equal(await focused(), 'Default');
    await page.keyboard.press('ArrowRight');
    const second = await focused();
    assert.notEqual(second, 'Default');
    await page.keyboard.press('ArrowDown');
    const below = await focused();
    await page.keyboard.press('ArrowUp');
    assert.equal(await focused(), second, `back from ${below}`);
    await dialog.getByRole('searchbox').fill('silk curt');
    await until(async () => (await choices.count()) === 1);
    await page.keyboard.press('Enter');
    await until(async () => (await read(page, 'scene')) === 'fan', 'the scene that was found is loaded');
    assert.ok(!(await dialog.isVisible()));
    await page.keyboard.press('l');
    await dialog.getByRole('searchbox').fill('nothing like it');
    await until(() => dialog.getByText('No scene is called so.').isVisible());
    await page.keyboard.press('Escape');
    await script.load('default');
    await until(async () => (await read(page, 'scene')) === 'default');
    // Pictures come when they are looked at.
    const total = (await readdir(pictures)).length;
    const came = asked.filter((path) => path.endsWith('.jpg')).length;
    if (total > 30) assert.ok(came < total, `${came} of ${total}`);
  }),
);

test('what a choice does to others is read above the search, on wide screens and on a phone', bounded, () =>
  with_page({ paused: true }, async (page) => {
    for (const [width, height] of [[1280, 800], [390, 844], [844, 390]]) {
      await page.setViewportSize({ width, height });
      await page.locator('#view').focus();
      await page.keyboard.press('l');
      await until(() => page.locator('#scene-list img').count(), 'pictures are there');
      const words = page.getByText('What you choose is loaded for everybody who looks at this cloth.');
      assert.equal(await page.locator('#scenes').evaluate((dialog) => dialog.scrollTop), 0);
      const clip = await words.boundingBox();
      const shown = await page.screenshot({ clip });
      const search = page.locator('#scene-search');
      await search.evaluate((field) => (field.style.display = 'none'));
      assert.ok(shown.equals(await page.screenshot({ clip })), `nothing lies over them at ${width} x ${height}`);
      await search.evaluate((field) => (field.style.display = ''));
      await page.keyboard.press('Escape');
    }
  }),
);

/** Bytes of a file as the server sends it to who takes gzip alone. */
async function gzipped(url) {
  const [answer] = await once(get(url, { headers: { 'accept-encoding': 'gzip' } }), 'response');
  let bytes = 0;
  for await (const part of answer) bytes += part.length;
  return bytes;
}

test('the first load is at most 180 kB, by gzip too, without what is opened later', bounded, () =>
  with_page({ simple: false }, async (page) => {
    await until(() => read(page, 'lit'), 'all that follows the first picture has come');
    const entries = await page.evaluate(() =>
      ['navigation', 'resource'].flatMap((type) =>
        performance.getEntriesByType(type).map(({ name, encodedBodySize, transferSize }) => ({
          name, size: Math.min(encodedBodySize, transferSize), whole: transferSize >= encodedBodySize,
        })),
      ),
    );
    // What the worker shares with the page comes once, and is only asked about again.
    const loads = entries.filter(({ whole }) => whole).map(({ name, size }) => [name, size]);
    assert.equal(new Set(loads.map(([name]) => name)).size, loads.length, 'nothing comes twice');
    const names = loads.map(([name]) => new URL(name).pathname);
    const sizes = await Promise.all(loads.map(([name]) => gzipped(name)));
    for (const each of [loads.map(([, size]) => size), sizes]) {
      const total = each.reduce((sum, size) => sum + size, 0);
      assert.ok(total > 50_000 && total <= 180_000, `${total} bytes: ${each} of ${names}`);
    }
    assert.ok(names.includes('/main.js') && names.includes('/styles.css'), `${names}`);
    assert.ok(!names.some((name) => /scene_dialog|textile_marks|scenes\//.test(name)), `${names}`);
  }),
);

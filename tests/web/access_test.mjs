import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import test from 'node:test';
import { open_page, read, until } from './support/browser.mjs';
import { browser, server } from './support/default_page.mjs';
import { bounded } from './support/default_scene.mjs';
import { require_package } from './support/packages.mjs';

// That everybody can use the page: axe on all of it, and room for the cloth and for fingers.

const axe = await readFile(require_package.resolve('axe-core/axe.min.js'), 'utf8');
const PHONE = { width: 390, height: 844, touch: true };
const LOOKS = [
  ['light', { width: 1280, height: 800 }],
  ['dark', { width: 1280, height: 800, dark: true }],
  ['phone', PHONE],
  ['dark phone', { ...PHONE, dark: true }],
];

/** Stops the room: what stands still is not drawn, which leaves the browser to axe. */
async function stand_still() {
  const script = await server.script();
  await script.pause();
  script.close();
}

/** Rules that are broken, and those that axe could not decide, each with its elements. */
async function faults(page) {
  const { violations, incomplete } = await page.evaluate(() =>
    window.axe.run({ resultTypes: ['violations', 'incomplete'] }),
  );
  const words = ({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target.join(' ')).join(', ')}`;
  return { violations: violations.map(words), incomplete: incomplete.map(words) };
}

for (const [look, options] of LOOKS) {
  test(`axe finds no fault, and leaves nothing undecided: ${look}`, bounded, async () => {
    await stand_still();
    const page = await open_page(browser, server.url, { ...options, name: 'Ada' });
    // By the protocol, for the page's own policy allows no script from elsewhere.
    await page.evaluate(axe);
    const clean = async (what) =>
      assert.deepEqual(await faults(page), { violations: [], incomplete: [] }, what);
    await until(() => page.locator('#guarantee').isVisible(), 'all words are there');
    await clean('the page');
    const figures = page.getByRole('button', { name: 'Figures' });
    if ((await figures.getAttribute('aria-expanded')) === 'false') await figures.click();
    const more = page.getByRole('button', { name: 'Controls' });
    if (await more.isVisible()) await more.click();
    await page.locator('#boxes').click();
    await until(async () => (await read(page, 'boxes')).lines.length > 0, 'boxes are shown');
    await clean('everything open');
    await page.getByRole('list', { name: 'Viewers' }).getByRole('button').click();
    await until(() => page.getByRole('list', { name: 'People' }).isVisible(), 'the list is there, and moves nothing more');
    await clean('the dialog of the name');
    await page.keyboard.press('Escape');
    for (const key of ['?', 'l', 'a']) {
      await page.locator('#view').focus();
      await page.keyboard.press(key);
      await until(() => page.getByRole('dialog').isVisible());
      if (key === 'a') await until(() => page.getByRole('row').nth(1).isVisible(), 'rooms are listed');
      if (key === 'l') await until(() => page.locator('#scene-list img').count(), 'pictures are there');
      await clean(`the dialog of ${key}`);
      await page.keyboard.press('Escape');
    }
    await page.keyboard.press('a');
    await page.getByRole('button', { name: 'Wall of pictures' }).click();
    await until(() => page.getByRole('button', { name: /^default .*crossings/ }).isVisible(), 'the wall is there');
    await clean('the wall');
    assert.deepEqual(page.complaints, []);
    await page.context().close();
  });
}

const SMALL = [
  [844, 390],
  [640, 360],
  [320, 568],
  [390, 844],
];

test('on small screens panels and toolbar leave 60 % of the height, and nothing sticks out', bounded, async () => {
  const name = 'Maximilian-Alexander von Weft 32'; // the longest
  const page = await open_page(browser, server.url, { ...PHONE, name });
  const own = page.getByRole('list', { name: 'Viewers' }).getByRole('button');
  const clear = () => page.evaluate(() => {
    const rect = (element) => element.getBoundingClientRect();
    const shown = [...document.querySelectorAll('#top *, #toolbar, #toolbar *')].filter(
      (element) => element.checkVisibility() && !element.closest('svg *, .unseen, #connection-text'),
    );
    const out = shown.filter((element) => {
      const { left, right, top, bottom } = rect(element);
      const within = left >= 0 && right <= innerWidth && top >= 0 && bottom <= innerHeight;
      return !within;
    });
    const header = rect(document.querySelector('header'));
    const side = rect(document.querySelector('#side'));
    const lowest = Math.max(header.bottom, rect(document.querySelector('#summary')).bottom);
    return {
      free: (rect(document.querySelector('#toolbar')).top - lowest) / innerHeight,
      out: out.map((element) => element.id || element.className || element.tagName),
      apart: header.right <= side.left,
    };
  });
  const fits = async (who) => {
    for (const [width, height] of SMALL) {
      await page.setViewportSize({ width, height });
      await until(async () => (await read(page, 'size')).width === width);
      const at = `${who} at ${width} x ${height}`;
      const { free, out, apart } = await clear();
      assert.ok(free >= 0.6, `${at}: ${free} of the height is free`);
      assert.deepEqual(out, [], at);
      assert.ok(apart, `${at}: the panels keep apart`);
      for (const control of [own, page.locator('#room'), page.locator('#copy')])
        await control.click({ trial: true, timeout: 30_000 }); // nothing else lies over it
      await page.getByRole('button', { name: 'Controls' }).click();
      assert.deepEqual((await clear()).out, [], `${at} with all controls`);
      await page.getByRole('button', { name: 'Controls' }).click();
    }
  };
  await fits('alone');
  const other = await open_page(browser, server.url, { name: 'Ben' });
  await until(() => page.getByRole('button', { name: '2 people' }).isVisible(), 'both are counted');
  await fits('two');
  await other.context().close();
  await page.context().close();
});

test('what a finger presses or slides is at least 44 pixels high, and buttons as wide', bounded, async () => {
  const page = await open_page(browser, server.url, PHONE);
  await page.getByRole('button', { name: 'Controls' }).click();
  await page.getByRole('button', { name: 'Figures' }).click();
  const small = await page.evaluate(() =>
    [...document.querySelectorAll('button, input, select')]
      .filter((element) => element.checkVisibility())
      .map((element) => ({ id: element.id, box: element.getBoundingClientRect() }))
      .filter(({ box }) => box.height < 44 || box.width < 44)
      .map(({ id, box }) => `${id} ${box.width} x ${box.height}`),
  );
  assert.deepEqual(small, []);
  await page.context().close();
});

test('the help begins with touch on a phone, and with the mouse beside one', bounded, async () => {
  for (const [options, first, second] of [
    [PHONE, 'Touch', 'Mouse'],
    [{ width: 1280, height: 800 }, 'Mouse', 'Touch'],
  ]) {
    const page = await open_page(browser, server.url, options);
    await page.getByRole('button', { name: 'Help' }).click();
    const top = async (name) => (await page.getByRole('table', { name }).boundingBox()).y;
    assert.ok((await top(first)) < (await top(second)), `${first} before ${second}`);
    await page.context().close();
  }
});

test('the theme follows the system until one is chosen, which is remembered', bounded, async () => {
  const page = await open_page(browser, server.url, { dark: true });
  const luma = () =>
    page.evaluate(() => {
      const [r, g, b] = getComputedStyle(document.querySelector('header')).backgroundColor.match(/\d+/g);
      return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    });
  assert.ok((await luma()) < 60, 'dark as the system');
  await page.emulateMedia({ colorScheme: 'light' });
  await until(async () => (await luma()) > 240, 'light as the system');
  await page.keyboard.press('Escape');
  await page.locator('#theme').evaluate((button) => button.click());
  await until(async () => (await luma()) < 60, 'dark as chosen');
  await page.reload();
  await until(() => page.evaluate(() => window.weft?.phase === 'open'));
  assert.ok((await luma()) < 60, 'remembered');
  await page.goto(`${server.url}?theme=light`);
  await until(() => page.evaluate(() => window.weft?.phase === 'open'));
  assert.ok((await luma()) > 240, 'as the address says');
  await page.context().close();
});

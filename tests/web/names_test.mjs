import assert from 'node:assert/strict';
import test from 'node:test';
import { next_pictures, read, until } from './support/browser.mjs';
import { server, with_page } from './support/default_page.mjs';
import { bounded } from './support/default_scene.mjs';
import { import_page_module } from './support/page_module.mjs';

// Names as the page shows them: long ones are cut, and none disturbs or imitates by what is not seen in it.

const { shown_name, without_unseen } = await import_page_module('wire/names');

const LONGEST = 'W'.repeat(32);
const shown = (name) => shown_name({ id: 7, name });

test('what is not seen in a name, or turns its letters, is shown by a substitute', () => {
  assert.equal(shown('\u202eTeacher'), '\ufffdTeacher');
  const others = ['\u200b', '\u2066', '\u200f', '\ufeff', '\u00ad', '\u0085', '\u2028', '\u2029', '\u3164', '\u2800'];
  for (const unseen of [...others, '\u{e0041}'])
    assert.equal(shown(`A${unseen}da`), 'A\ufffdda', escape(unseen));
  assert.equal(shown('Ada\u200d'), 'Ada\ufffd', 'a joiner beside nothing');
  assert.equal(without_unseen('\u202eA\u200bda', ''), 'Ada');
});

test('joiners between letters and within an emoji stay, as does every letter', () => {
  for (const name of ['Ada', 'Zoë', 'می\u200cخواهم', 'क्\u200dष', '李', 'שלום', '👩🏽\u200d🔬', '❤\ufe0f'])
    assert.equal(shown(name), name);
});

test('a name in which nothing is seen is that of a viewer without a name', () => {
  for (const name of ['', ' ', '\u200b', '\u202e\u2069', '\u00a0\u3000', '\u3164', '\u0301', '\u2800'])
    assert.equal(shown(name), 'viewer 7', escape(name));
});

/** Opens a page at a room with scripts of these names, and sees all off. */
const with_named = (names, options, act) =>
  with_page({ paused: true, ...options }, async (page, script) => {
    const others = await Promise.all(names.map((name) => server.script(name)));
    try {
      await act(page, script, ...others);
    } finally {
      for (const other of others) other.close();
    }
  });

/** What of the page is not within something of it, by its words. */
const outside = (page, frame, parts) =>
  page.locator(frame).evaluate((box, selector) => {
    const { left, right } = box.getBoundingClientRect();
    return [...box.querySelectorAll(selector)]
      .filter((part) => part.checkVisibility())
      .filter((part) => part.getBoundingClientRect().left < left || part.getBoundingClientRect().right > right)
      .map((part) => part.title || part.textContent);
  }, parts);

/** Asserts that a name is cut, and told in full where the mouse rests. */
async function is_cut(name, what) {
  const { cut, title } = await name.evaluate((element) => ({
    cut: element.scrollWidth > element.clientWidth && getComputedStyle(element).textOverflow === 'ellipsis',
    title: element.title,
  }));
  assert.ok(cut, what);
  assert.equal(title, LONGEST, what);
}

test('the longest name is cut wherever it is shown, and leaves every control and word in its place', bounded, () =>
  with_named([LONGEST], { width: 1280, height: 800, name: LONGEST }, async (page, script, other) => {
    for (const [width, height, lines] of [[1280, 800, 1], [390, 844, 2], [320, 568, 3]]) {
      const at = `at ${width} x ${height}`;
      await page.setViewportSize({ width, height });
      await until(async () => (await read(page, 'size')).width === width);
      await until(async () => (await page.locator('#viewers li').count()) === (width > 600 ? 3 : 1), `who is here ${at}`);
      const edge = page.locator(`#viewers [title=${LONGEST}]`);
      if (width > 600) for (const k of [0, 1]) await is_cut(edge.nth(k), `at the screen’s edge ${at}`);
      assert.deepEqual(await outside(page, 'header', '*'), [], at);
      const rows = await page.locator('#guarantee-text').evaluate((text) => {
        const range = document.createRange();
        range.selectNodeContents(text);
        return new Set([...range.getClientRects()].map(({ top }) => Math.round(top))).size;
      });
      assert.ok(rows <= lines, `the guarantee takes ${rows} lines ${at}`);
      await page.getByRole('list', { name: 'Viewers' }).getByRole('button').click();
      const list = page.getByRole('list', { name: 'People' });
      await until(async () => (await list.getByRole('button', { name: 'Follow' }).count()) === 2, 'the list of people');
      assert.deepEqual(await outside(page, '#name-dialog', 'button, input, label, .viewer-name, .role'), [], at);
      assert.equal(await page.locator('#name-dialog').evaluate((box) => box.scrollWidth - box.clientWidth), 0, at);
      for (const k of [0, 1]) await is_cut(list.getByTitle(LONGEST).nth(k), `in the list of people ${at}`);
      await page.keyboard.press('Escape');
    }
    await page.setViewportSize({ width: 390, height: 844 });
    const [place] = await script.query('positions');
    other.post('presence', { cursor: place });
    await until(() => page.locator('.name').count(), 'its cursor');
    await is_cut(page.locator('.name .viewer-name'), 'at a cursor');
    other.drag({ particle: 0 }, { target: place });
    await until(() => page.locator('.name', { hasText: ' N' }).count(), 'its hand');
    await is_cut(page.locator('.name .viewer-name'), 'at a hand');
    await other.lead();
    await until(() => page.locator('#toast .viewer-name').count(), 'a sentence about it');
    await is_cut(page.locator('#toast .viewer-name'), 'in a sentence');
    await until(() => page.locator('#following').isVisible(), 'whom the page follows');
    await is_cut(page.locator('#following .viewer-name'), 'in the corner');
    assert.deepEqual(await outside(page, 'header', '*'), []);
  }),
);

test('on small screens who is alone is named, and more are counted; a tap on the count lists them', bounded, () =>
  with_named([], { width: 375, height: 667, name: LONGEST }, async (page, script) => {
    script.close();
    const sizes = [[375, 667], [667, 375], [500, 400]];
    const resize = async ([width, height]) => {
      await page.setViewportSize({ width, height });
      await until(async () => (await read(page, 'size')).width === width);
    };
    const whole = (words) => page.locator(words).evaluate((one) => one.scrollWidth <= one.clientWidth);
    const viewers = page.getByRole('list', { name: 'Viewers' });
    for (const size of sizes) {
      await resize(size);
      await until(async () => (await viewers.getByRole('listitem').count()) === 1, 'it is alone');
      await is_cut(viewers.getByTitle(LONGEST), `at ${size}`);
      assert.deepEqual(await outside(page, '#viewers', 'li, .viewer-name'), [], `at ${size}`);
    }
    const others = await Promise.all(['Ada', 'Ben', 'Carl', 'Dora', 'Emil', 'Fritz'].map((name) => server.script(name)));
    for (const size of sizes) {
      await resize(size);
      const count = viewers.getByRole('button', { name: '7 people' });
      await until(() => count.isVisible(), `they are counted at ${size}`);
      assert.equal(await viewers.getByRole('listitem').count(), 1);
      assert.deepEqual(await outside(page, 'header', '*'), [], `at ${size}`);
      assert.ok(await whole('#room-name'), `the room’s name is whole at ${size}`);
      assert.ok((await page.locator('header').boundingBox()).height < 130, 'the cloth has its room');
      await count.click();
      const list = page.getByRole('list', { name: 'People' });
      await until(async () => (await list.getByRole('listitem').count()) === 7, 'all are listed');
      await page.keyboard.press('Escape');
    }
    await resize([1280, 800]);
    await until(() => viewers.getByRole('button', { name: 'and 1 more' }).isVisible(), 'six are named on a wide screen');
    for (const other of others) other.close();
  }),
);

test('names of seven hands near each other are all read, on a wide screen and on a phone', bounded, () =>
  with_named(Array(7).fill(LONGEST), { width: 1280, height: 800 }, async (page, script, ...others) => {
    const [positions, particles] = [await script.query('positions'), [130, 131, 132, 160, 161, 190, 191]];
    others.forEach((other, k) => {
      const [x, y, z] = positions[particles[k]];
      // Some behind the form, some before the cloth.
      other.drag({ particle: particles[k] }, { target: [x, y, z + (k % 2 ? 0.2 : -0.6)] });
    });
    for (const [width, height] of [[1280, 800], [375, 667]]) {
      const at = `at ${width} x ${height}`;
      await page.setViewportSize({ width, height });
      await until(async () => (await read(page, 'size')).width === width);
      const labels = await until(async () => {
        await next_pictures(page);
        const all = await page.locator('.name').filter({ hasText: ' N' }).evaluateAll((all) =>
          all.filter((label) => label.checkVisibility()).map((label) => {
            const { left, right, top, bottom } = label.getBoundingClientRect();
            return { left, right, top, bottom, opacity: getComputedStyle(label).opacity };
          }));
        return all.length === 7 && all;
      }, `all are there ${at}`);
      for (const [k, one] of labels.entries()) {
        assert.equal(one.opacity, '1', at);
        assert.ok(one.right - one.left < width / 2, `${one.right - one.left} wide ${at}`);
        for (const other of labels.slice(k + 1)) {
          const beside = one.right <= other.left || other.right <= one.left || one.bottom <= other.top || other.bottom <= one.top;
          assert.ok(beside, `${JSON.stringify([one, other])} ${at}`);
        }
      }
    }
  }),
);

test('a long name of a room leaves what closes it in sight', bounded, () =>
  with_page({ width: 390, height: 844, paused: true }, async (page, script) => {
    const name = 'w'.repeat(32);
    await script.createRoom(name);
    await page.locator('#view').focus();
    await page.keyboard.press('a');
    const close = page.getByRole('button', { name: `Close ${name}` });
    await until(() => close.isVisible(), 'rooms are listed');
    const { x, width } = await close.boundingBox();
    const dialog = await page.getByRole('dialog', { name: 'Rooms' }).boundingBox();
    assert.ok(x > dialog.x && x + width < dialog.x + dialog.width);
    assert.ok((await page.getByTitle(name, { exact: true }).boundingBox()).width < dialog.width / 2);
    await script.closeRoom(name);
  }),
);

/** Has a page hear names from the server that the server itself might refuse. Runs in the page before its scripts. */
function hear_deceivers() {
  const parse = JSON.parse;
  const deceive = (text) => text.replaceAll('Mallory', '\\u202eTeacher').replaceAll('Nobody', '\\u200b');
  JSON.parse = (text, ...rest) => parse(deceive(text), ...rest);
}

test('a name neither turns nor hides letters, its own or those beside it', bounded, () =>
  with_named(['Mallory', 'Nobody', 'עדה'], { width: 900, height: 600, before: hear_deceivers }, async (page, script, ...others) => {
    const [mallory, nobody, hebrew] = others;
    const known = ['\ufffdTeacher', `viewer ${nobody.viewer}`, 'עדה'];
    const names = (list) => page.locator(`${list} .viewer-name`).allTextContents();
    await until(async () => (await names('#viewers')).length === 5, 'all are listed');
    for (const name of known) assert.ok((await names('#viewers')).includes(name), name);
    await page.getByRole('list', { name: 'Viewers' }).getByRole('button').click();
    await until(() => page.getByRole('button', { name: 'Follow \ufffdTeacher' }).isVisible(), 'the list of people');
    for (const name of known) assert.ok((await names('#people')).includes(name), name);
    await page.keyboard.press('Escape');
    await mallory.reset();
    await until(async () => (await page.locator('#toast').textContent()) === '\ufffdTeacher reset the scene');
    // Isolated, each with the direction of its own letters.
    const [place] = await script.query('positions');
    hebrew.drag({ particle: 0 }, { target: place });
    const label = page.locator('.name', { hasText: ' N' });
    await until(() => label.count(), 'a hand');
    const order = await label.evaluate((element) => {
      const force = document.createRange();
      force.selectNodeContents(element.lastChild);
      const name = element.querySelector('bdi');
      const first = name.getBoundingClientRect().right <= force.getBoundingClientRect().left + 1;
      return [first, getComputedStyle(name).direction];
    });
    assert.deepEqual(order, [true, 'rtl'], 'the name comes first, and the force after it');
  }),
);

test('what is typed as a name is sent without what would not be seen', bounded, () =>
  with_page({ name: '\u202eAda\u200b' }, async (page, script) => {
    const own = await read(page, 'viewer');
    const roster = await script.query('roster');
    assert.equal(roster.find(({ id }) => id === own).name, 'Ada');
  }),
);

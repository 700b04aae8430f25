import assert from 'node:assert/strict';
import test from 'node:test';
import { open_page, read, until } from './support/browser.mjs';
import { browser, server, with_page } from './support/default_page.mjs';
import { CALM, bounded } from './support/default_scene.mjs';
import { start_server } from './support/server.mjs';

// Where the focus of the keyboard is: it is never dropped, and always seen.

const WIDE = { width: 900, height: 600, paused: true, name: 'Ada' };
const FLAT = { width: 640, height: 400, paused: true, name: 'Ada' };

const focused = (page) => page.evaluate(() => document.activeElement.id || document.activeElement.title);
const has_focus = (page, id, when) => until(async () => (await focused(page)) === id, `the focus is on ${id} ${when}`);
const opener = (page) => page.getByRole('list', { name: 'Viewers' }).getByRole('button');
const framed = (page) => page.locator('#view').evaluate((view) => getComputedStyle(view).outlineStyle !== 'none');

/** Opens the list of people by a key, and waits until it is there. */
async function list_people(page) {
  await opener(page).press('Enter');
  await until(() => page.getByRole('list', { name: 'People' }).isVisible(), 'people are listed');
}

for (const [what, size, title] of [['own name', WIDE, 'Change your name'], ['count of people', FLAT, 'Who is here']])
  test(`others that come and go, and a new name, leave the focus on the ${what}`, bounded, () =>
    with_page(size, async (page, script) => {
      const shows = (words) =>
        until(async () => (await page.locator('#viewers').textContent()).includes(words), `${words} is shown`);
      await opener(page).focus();
      const other = await open_page(browser, server.url, { name: 'Ben' });
      await shows(size === WIDE ? 'Ben' : '3 people');
      assert.equal(await focused(page), title, 'another has come');
      await other.context().close();
      await until(async () => (await script.query('roster')).length === 2, 'and has gone');
      assert.equal(await focused(page), title);
      await list_people(page);
      await page.getByRole('textbox', { name: 'Name' }).fill('Eva');
      await page.keyboard.press('Enter');
      const told = async () => (await script.query('roster')).some(({ name }) => name === 'Eva');
      await until(told, 'the name is told');
      if (size === WIDE) await shows('Eva');
      assert.equal(await focused(page), title, 'with the new name');
    }),
  );

test('a button that hides itself gives the focus to the cloth', bounded, () =>
  with_page(WIDE, async (page) => {
    const other = await open_page(browser, server.url, { name: 'Ben' });
    await list_people(page);
    await page.getByRole('button', { name: 'Follow Ben' }).press('Enter');
    await until(() => page.locator('#following').isVisible(), 'another is followed');
    await page.keyboard.press('Escape');
    await page.locator('#following').press('Enter');
    await until(() => page.locator('#following').isHidden(), 'and no more');
    await has_focus(page, 'view', 'after Stop');
    await page.keyboard.press('t');
    await until(() => page.locator('#room-back').isVisible(), 'it is in a copy');
    await until(async () => (await read(page, 'phase')) === 'open');
    await page.locator('#room-back').press('Enter');
    await until(() => page.locator('#room-back').isHidden(), 'it is back');
    await has_focus(page, 'view', 'after Back');
    await other.context().close();
  }),
);

test('a person that leaves the list leaves the focus in it', bounded, () =>
  with_page(WIDE, async (page) => {
    const other = await open_page(browser, server.url, { name: 'Ben' });
    await list_people(page);
    const follow = page.getByRole('button', { name: 'Follow Ben' });
    await follow.focus();
    await other.context().close();
    await until(async () => (await follow.count()) === 0, 'the row has gone');
    assert.ok(await page.evaluate(() => document.activeElement.closest('dialog') !== null));
    await page.keyboard.press('Escape');
    await has_focus(page, 'Change your name', 'after the dialog');
  }),
);

test('what the absence of the server disables has the focus back after it', bounded, async () => {
  let own = await start_server(CALM);
  const { port } = new URL(own.url);
  const page = await open_page(browser, own.url, { ...WIDE });
  try {
    for (const [control, id] of [[page.locator('#pause'), 'pause'], [opener(page), 'Change your name']]) {
      await control.focus();
      await own.stop('SIGKILL');
      own = null;
      await until(async () => (await read(page, 'phase')) === 'waiting');
      assert.equal(await focused(page), 'view', 'meanwhile it is on the cloth');
      own = await start_server(CALM, Number(port));
      await until(async () => (await read(page, 'phase')) === 'open');
      await has_focus(page, id, 'again');
    }
    await page.locator('#pause').focus();
    await own.stop('SIGKILL');
    own = null;
    await has_focus(page, 'view', 'while the server is away');
    await page.keyboard.press('f');
    own = await start_server(CALM, Number(port));
    await until(() => page.locator('#pause').isEnabled());
    assert.equal(await focused(page), 'view', 'a key pressed meanwhile keeps it where it is');
  } finally {
    await page.context().close();
    await own?.stop();
  }
});

test('a dialog that a key has opened gives the view its frame back', bounded, () =>
  with_page({ paused: true }, async (page) => {
    await page.keyboard.press('Tab');
    assert.equal(await focused(page), 'view');
    for (const key of ['?', 'l']) {
      await page.keyboard.press(key);
      await until(() => page.getByRole('dialog').isVisible(), `${key} opens a dialog`);
      await page.keyboard.press('Escape');
      await has_focus(page, 'view', 'again');
      assert.ok(await framed(page), `after ${key}`);
    }
    await page.mouse.click(20, 300);
    await page.keyboard.press('?');
    await page.keyboard.press('Escape');
    assert.equal(await framed(page), false, 'and none after a click');
  }),
);

test('the frame of the button of people is whole on flat screens', bounded, () =>
  with_page(FLAT, async (page) => {
    const style = (selector, name, value) =>
      page.locator(selector).evaluate((one, [key, wanted]) => (one.style[key] = wanted), [name, value]);
    await style('#view', 'visibility', 'hidden'); // behind the header the picture gets finer
    await page.locator('#copy').focus();
    await page.keyboard.press('Tab');
    assert.equal(await focused(page), 'Who is here');
    for (const size of [{ width: 640, height: 400 }, { width: 740, height: 360 }]) {
      await page.setViewportSize(size);
      const clip = await page.locator('header').boundingBox();
      const shown = await page.screenshot({ clip });
      await style('#viewers', 'overflow', 'visible');
      assert.ok(shown.equals(await page.screenshot({ clip })), `at ${size.width} x ${size.height}`);
      await style('#viewers', 'overflow', '');
    }
  }),
);

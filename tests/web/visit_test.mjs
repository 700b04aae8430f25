import assert from 'node:assert/strict';
import test from 'node:test';
import { done, open_page, read, until } from './support/browser.mjs';
import { browser, server, with_page } from './support/default_page.mjs';
import { bounded, drag_cloth, show_controls } from './support/default_scene.mjs';

// A viewer's first visit, name and window.

const joined = (page) => until(() => page.evaluate(() => window.weft?.tick >= 0));

test('a first visit tells that the cloth can be taken, until it is', bounded, () =>
  with_page({}, async (page) => {
    const hint = page.locator('#hint');
    assert.match(await hint.textContent(), /drag it with the mouse/);
    assert.ok(await hint.isVisible());
    await drag_cloth(page, 0, -20);
    await until(() => hint.isHidden(), 'it goes with the first drag');
    await page.mouse.up();
    await page.reload();
    await joined(page);
    assert.ok(await hint.isHidden(), 'and does not come again');
  }),
);

test('open controls take the place of the hint wherever they lie above the toolbar', bounded, () =>
  with_page({ paused: true }, async (page) => {
    const hint = page.locator('#hint');
    const more = page.getByRole('button', { name: 'Controls' });
    for (const [width, height] of [[390, 844], [810, 1080], [740, 360], [1024, 700]]) {
      await page.setViewportSize({ width, height });
      await until(() => hint.isVisible(), `the hint is there at ${width} x ${height}`);
      await more.click();
      assert.ok(await hint.isHidden(), `at ${width} x ${height}`);
      await more.click();
    }
  }),
);

test('a viewer types a name, which others see and the browser remembers', bounded, () =>
  with_page({ width: 900, height: 600 }, async (page, script) => {
    const other = await open_page(browser, server.url, { width: 900, height: 600, name: 'Ben' });
    await page.getByRole('list', { name: 'Viewers' }).getByRole('button').click();
    const dialog = page.getByRole('dialog', { name: 'People' });
    const input = dialog.getByRole('textbox', { name: 'Name' });
    await input.fill('  Ada Lovelace  ');
    await page.keyboard.press('Enter');
    await until(() => dialog.isHidden());
    const names = async (shown) => shown.locator('#viewers .viewer-name').allTextContents();
    await until(async () => (await names(other)).includes('Ada Lovelace'), 'the other sees it');
    await until(async () => (await names(page))[0] === 'Ada Lovelace', 'the own name comes first');
    await page.reload();
    await joined(page);
    await done(page); // its name was sent first
    const own = await read(page, 'viewer');
    const viewers = await script.query('roster');
    assert.equal(viewers.find(({ id }) => id === own).name, 'Ada Lovelace', 'it is remembered');
    await until(async () => (await names(other)).includes('Ada Lovelace'), 'the other sees it again');
    await other.context().close();
  }),
);

test('H hides the panels and brings them back, as does a button where there are no keys', bounded, () =>
  with_page({}, async (page) => {
    const toolbar = page.getByRole('navigation');
    await page.locator('#view').focus();
    await page.keyboard.press('h');
    for (const id of ['top', 'toolbar', 'hint']) assert.ok(await page.locator(`#${id}`).isHidden(), id);
    await page.keyboard.press('h');
    assert.ok(await toolbar.isVisible());
    await show_controls(page);
    await page.getByRole('button', { name: 'Hide the panels' }).click();
    assert.ok(await toolbar.isHidden());
    await page.getByRole('button', { name: 'Show the panels' }).click();
    assert.ok(await toolbar.isVisible());
    assert.ok(await page.getByRole('button', { name: 'Show the panels' }).isHidden());
  }),
);

test('the page fills the screen and leaves it again', bounded, () =>
  with_page({}, async (page) => {
    await show_controls(page);
    const button = page.getByRole('button', { name: 'Full screen' });
    const full = () => page.evaluate(() => document.fullscreenElement !== null);
    await button.click();
    await until(full);
    const pressed = (wanted) =>
      until(async () => (await button.getAttribute('aria-pressed')) === wanted, `pressed: ${wanted}`);
    await pressed('true');
    await button.click();
    await until(async () => !(await full()));
    await pressed('false');
  }),
);

import assert from 'node:assert/strict';
import test from 'node:test';
import { done, open_page, read, until } from './support/browser.mjs';
import { browser, server, with_page } from './support/default_page.mjs';
import { bounded, drag_cloth } from './support/default_scene.mjs';
import { import_page_module } from './support/page_module.mjs';

// What the page says of what others do, and of what happens to the own hand.

const { loss_text, notice_text } = await import_page_module('panel/events');
const { named } = await import_page_module('view/words');

const present = { own: 1, scene: 'Flag', name: (id) => ({ 1: 'Ada', 2: 'ben' })[id] };
const says = (code, viewer, level = 'info') =>
  notice_text({ op: 'notice', level, code, viewer, message: 'as the server says it' }, present);

test('a sentence names who reset or loaded, also to the one who did', () => {
  assert.equal(says('reset', 1), 'You reset the scene');
  assert.equal(says('reset', 2), `${named('Ben')} reset the scene`);
  assert.equal(says('reset', 7), 'Somebody reset the scene');
  assert.equal(says('reset', undefined), 'Somebody reset the scene');
  assert.equal(says('loaded', 2), `${named('Ben')} chose the scene “Flag”`);
});

test('only what nothing else shows is told, and each loss of the hand once', () => {
  assert.equal(says('within_budget', undefined), null);
  assert.equal(says('slow_motion', undefined, 'warning'), null);
  assert.equal(says('recovered', undefined, 'warning'), 'as the server says it');
  assert.match(says('lease_expired', 1, 'warning'), /^Your hand let go, because /);
  assert.equal(says('lease_expired', 2, 'warning'), null);
  assert.equal(loss_text('released by the server'), null);
  assert.equal(loss_text('lease expired'), null);
  assert.match(loss_text('another hand holds it'), /: another hand holds it$/);
});

test('who holds the cloth while another resets or loads reads who did what', bounded, () =>
  with_page({ name: 'Ada' }, async (page) => {
    const other = await open_page(browser, server.url, { name: 'Ben' });
    // All sentences, for the next one may come before the test looks.
    const record = () => {
      window.told = [];
      const toast = document.getElementById('toast');
      const note = () => window.told.push(toast.textContent);
      new MutationObserver(note).observe(toast, { childList: true });
    };
    const told = (shown) => shown.evaluate(() => window.told);
    const heard = (shown, text) =>
      until(async () => (await told(shown)).includes(text), text);
    for (const shown of [page, other]) await shown.evaluate(record);
    await drag_cloth(page, 0, -30);
    await other.keyboard.press('r');
    await heard(page, 'Ben reset the scene');
    await heard(other, 'You reset the scene');
    await until(async () => (await read(page, 'input')) === 'idle', 'the hand has let go');
    await page.mouse.up();
    await drag_cloth(page, 0, -30);
    await other.getByRole('button', { name: 'Scenes' }).click();
    await other.getByRole('button', { name: /^Flag/ }).click();
    await heard(page, 'Ben chose the scene “Flag”');
    await heard(other, 'You chose the scene “Flag”');
    await until(async () => (await read(page, 'input')) === 'idle');
    await page.mouse.up();
    for (const shown of [page, other]) await done(shown);
    const all = [...(await told(page)), ...(await told(other))].join('; ');
    assert.doesNotMatch(all, /slip|released|could not/);
    const script = await server.script();
    await script.load('default');
    script.close();
    await other.context().close();
  }),
);

test('a key after a click leaves the view without a frame; Tab gives it one', bounded, () =>
  with_page({}, async (page) => {
    const framed = () =>
      page.locator('#view').evaluate((view) => {
        const { boxShadow, outlineStyle } = getComputedStyle(view);
        return boxShadow !== 'none' || outlineStyle !== 'none';
      });
    await page.mouse.click(20, 300);
    await page.keyboard.press('Space');
    assert.equal(await framed(), false);
    await page.keyboard.press('Space');
    await page.locator('#pause').focus();
    const back = async () => {
      await page.keyboard.press('Shift+Tab');
      return framed();
    };
    await until(back, 'the keyboard has come to the view');
  }),
);

test('Space pauses after a click on any control, and presses a button that Tab leads to', bounded, () =>
  with_page({ width: 1280, height: 800, paused: true }, async (page, script) => {
    const paused = (wanted) => until(async () => (await read(page, 'paused')) === wanted, `paused: ${wanted}`);
    const resets = [];
    script.on('notice', ({ code }) => code === 'reset' && resets.push(code));
    let now = true;
    for (const control of ['Reset', 'Sling', 'Figures', 'Frame the cloth']) {
      await page.getByRole('button', { name: control, exact: true }).click();
      await page.keyboard.press('Space');
      now = !now;
      await paused(now);
    }
    await page.getByRole('slider', { name: 'Wind' }).click();
    await page.keyboard.press('Space');
    await paused(!now);
    await done(page);
    await script.query('state');
    assert.equal(resets.length, 1, 'the click alone');
    assert.equal(await page.locator('#sling').getAttribute('aria-pressed'), 'true');
    await page.locator('#pause').focus();
    await page.keyboard.press('Tab');
    assert.equal(await page.evaluate(() => document.activeElement.id), 'reset');
    await page.keyboard.press('Space');
    await until(() => resets.length === 2, 'the key presses it');
    await done(page);
    assert.equal(await read(page, 'paused'), !now, 'and does not pause');
    await script.set({ wind: [0, 0, 0] });
  }),
);

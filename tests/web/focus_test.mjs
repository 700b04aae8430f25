import assert from 'node:assert/strict';
import test from 'node:test';
import { until } from './support/browser.mjs';
import { with_page } from './support/default_page.mjs';
import { bounded } from './support/default_scene.mjs';

// Where the focus of the keyboard is: it is always seen.

const FLAT = { width: 640, height: 400, paused: true, name: 'Ada' };

const focused = (page) => page.evaluate(() => document.activeElement.id || document.activeElement.title);
const has_focus = (page, id, when) => until(async () => (await focused(page)) === id, `the focus is on ${id} ${when}`);
const framed = (page) => page.locator('#view').evaluate((view) => getComputedStyle(view).outlineStyle !== 'none');

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

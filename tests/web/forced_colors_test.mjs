import assert from 'node:assert/strict';
import test from 'node:test';
import { until } from './support/browser.mjs';
import { with_page } from './support/default_page.mjs';
import { bounded } from './support/default_scene.mjs';

// The page where the system forces its own colours, as for high contrast: backgrounds and shadows say nothing there.

/** A page whose room stands, and whose picture is not seen, as it gets finer. */
const with_forced_colors = (size, act) =>
  with_page({ ...size, paused: true, name: 'Ada' }, async (page, script) => {
    await page.emulateMedia({ forcedColors: 'active' });
    await page.locator('#view').evaluate((view) => (view.style.opacity = '0'));
    await act(page, script);
  });

test('in forced colours a pressed button looks other than one that is not', bounded, () =>
  with_forced_colors({ width: 1100, height: 600 }, async (page, script) => {
    const looks = async (button) => {
      await page.mouse.move(550, 300);
      await page.evaluate(() => document.activeElement.blur());
      return page.screenshot({ clip: await button.boundingBox() });
    };
    const differs = async (button, press = () => button.click()) => {
      const before = await looks(button);
      await press();
      const after = await looks(button);
      assert.ok(!before.equals(after), await button.evaluate((one) => one.id || one.textContent));
    };
    await differs(page.locator('#more'));
    for (const id of ['sling', 'objects', 'figures']) await differs(page.locator(`#${id}`));
    await script.policy('everybody');
    await page.getByRole('list', { name: 'Viewers' }).getByRole('button').click();
    const policy = page.getByRole('button', { name: 'Others watch' });
    await differs(policy, async () => {
      await policy.click();
      await until(async () => (await policy.getAttribute('aria-pressed')) === 'true', 'it is the policy');
    });
    await script.policy('everybody');
  }),
);

test('in forced colours the view that Tab leads to has a frame', bounded, () =>
  with_page({ paused: true }, async (page) => {
    await page.emulateMedia({ forcedColors: 'active' });
    const width = () => page.locator('#view').evaluate((view) => {
      const { outlineStyle, outlineWidth } = getComputedStyle(view);
      return outlineStyle === 'none' ? 0 : parseFloat(outlineWidth);
    });
    assert.equal(await width(), 0);
    await page.keyboard.press('Tab');
    assert.ok((await width()) >= 2);
  }),
);

test('in forced colours the dots that say a state or a viewer’s colour are seen', bounded, () =>
  with_forced_colors({ width: 390, height: 844 }, async (page) => {
    await until(() => page.locator('#guarantee').isVisible(), 'all words are there');
    for (const dot of await page.locator('.dot, .swatch').all()) {
      if (!(await dot.isVisible())) continue;
      const clip = await dot.boundingBox();
      const shown = await page.screenshot({ clip });
      await dot.evaluate((one) => (one.style.visibility = 'hidden'));
      assert.ok(!shown.equals(await page.screenshot({ clip })), await dot.evaluate((one) => one.parentElement.id));
    }
  }),
);

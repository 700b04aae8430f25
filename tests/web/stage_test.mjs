import assert from 'node:assert/strict';
import test from 'node:test';
import { camera_at_rest, read, until } from './support/browser.mjs';
import { with_page, with_server } from './support/default_page.mjs';
import { bounded } from './support/default_scene.mjs';
import { mean_color } from './support/silhouette.mjs';

// What becomes of the picture when the graphics fail, and how often its canvas is made anew.

const fine = (page) => until(() => read(page, 'fine'), 'the picture is a fine one');

/** Takes the graphics away from the page, or gives them back. */
const graphics = (page, act) =>
  page.evaluate((call) => {
    window.losing ??= document.getElementById('view').getContext('webgl2').getExtension('WEBGL_lose_context');
    window.losing[call]();
  }, act);

test('lost graphics are told, and come back with the same picture while nothing moves', bounded, () =>
  with_page({ paused: true, simple: false }, async (page, script) => {
    await until(() => read(page, 'lit'), 'the light is whole');
    await camera_at_rest(page);
    await fine(page);
    const before = await mean_color(page);
    const words = page.getByRole('alert').filter({ hasText: 'graphics' });
    assert.equal(await words.isVisible(), false);
    await graphics(page, 'loseContext');
    await until(() => words.isVisible(), 'the page says it');
    const pictures = await read(page, 'pictures');
    await graphics(page, 'restoreContext');
    await until(async () => !(await words.isVisible()), 'the words go');
    await until(async () => (await read(page, 'pictures')) > pictures, 'a picture is drawn');
    await until(() => read(page, 'lit'), 'the light is whole again');
    await fine(page);
    const after = await mean_color(page);
    before.forEach((part, i) => assert.ok(Math.abs(after[i] / part - 1) < 0.01, `${before} ${after}`));
  }),
);

test('the first, simple light stays where the address asks for it', bounded, () =>
  with_page({ paused: true }, async (page) => {
    await camera_at_rest(page);
    await fine(page); // which takes the whole light anywhere else
    assert.equal(await read(page, 'lit'), false);
  }),
);

test('a room of one tick a second does not change the size of the canvas at each of them', bounded, () =>
  with_server(['--scene', 'hard-step-second'], async (page) => {
    await page.evaluate(() => {
      window.sizes = 0;
      const canvas = document.getElementById('view');
      const own = Object.getOwnPropertyDescriptor(HTMLCanvasElement.prototype, 'width');
      const set = (value) => {
        window.sizes += 1;
        own.set.call(canvas, value);
      };
      Object.defineProperty(canvas, 'width', { get: () => own.get.call(canvas), set });
    });
    const tick = await read(page, 'tick');
    await until(async () => (await read(page, 'tick')) >= tick + 8);
    const sizes = await page.evaluate(() => window.sizes);
    // A rest cut short is two of them; the waits before the first three are 0.4, 1.6 and 6.4 s.
    assert.ok(sizes <= 6, `${sizes} sizes in eight ticks`);
  }),
);

import assert from 'node:assert/strict';
import test from 'node:test';
import { camera_at_rest, open_page, read, until } from './support/browser.mjs';
import { browser, server, with_page, with_server } from './support/default_page.mjs';
import { bounded, show_controls } from './support/default_scene.mjs';

// The controls around the view, and the list of scenes.

const CONTROLS = [
  ['button', /^Scenes: /],
  ['button', /^Room: /],
  ['button', 'Try it yourself'],
  ...['Pause', 'One step', 'Reset', 'Sling', 'Move objects', 'Fan', 'Boxes', 'Frame the cloth', 'Dark', 'Help']
    .concat('Figures', 'Full screen', 'Hide the panels')
    .map((name) => ['button', name]),
  ...['Speed', 'Wind', 'Gravity', 'Fan'].map((name) => ['slider', name]),
];

test('on screens wide and narrow every control is within reach and has a name', bounded, () =>
  with_page({ width: 400, height: 720 }, async (page, script) => {
    const controls = ['button', 'slider'];
    await show_controls(page);
    await page.getByRole('button', { name: 'Fan', exact: true }).click();
    await until(() => page.getByRole('slider', { name: 'Fan' }).isVisible());
    for (const [width, height] of [[1280, 700], [900, 500], [700, 500], [560, 420], [360, 640], [400, 720]]) {
      await page.setViewportSize({ width, height });
      await until(async () => (await read(page, 'size')).width === width);
      await show_controls(page);
      for (const [role, name] of CONTROLS) {
        const box = await page.getByRole(role, { name, exact: true }).boundingBox();
        const at = `${name} in ${width} x ${height}`;
        assert.ok(box.x >= 0 && box.x + box.width <= width, `${at} across`);
        assert.ok(box.y >= 0 && box.y + box.height <= height, `${at} down`);
      }
      const readable = (title) => title.clientWidth >= Math.min(title.scrollWidth, 90);
      assert.ok(await page.locator('#scene-title').evaluate(readable), `the scene’s name in ${width} x ${height}`);
    }
    await page.getByRole('button', { name: 'Fan', exact: true }).click();
    // The slider goes when the server says that the fan has gone, not with the click.
    const fans = page.getByRole('slider', { name: 'Fan', exact: true });
    await until(async () => (await fans.count()) === 0, 'the slider of the fan has gone');
    for (const role of controls) {
      for (const control of await page.getByRole(role).all()) {
        const named = (element) => element.matches('[aria-label], label *') || element.innerText !== '';
        assert.ok(await control.evaluate(named));
      }
    }
    await page.getByRole('slider', { name: 'Wind' }).focus();
    await page.keyboard.press('End');
    const wind = async () => Math.hypot(...(await script.query('state')).wind);
    await until(async () => Math.abs((await wind()) - 10) < 1e-6, 'the slider sets the wind');
    await script.set({ wind: [0, 0, 0] });
    await page.keyboard.press('?');
    const help = page.getByRole('dialog');
    assert.ok(await help.isVisible());
    await page.keyboard.press('Escape');
    assert.ok(!(await help.isVisible()));
    await page.setViewportSize({ width: 900, height: 500 });
    await until(async () => (await read(page, 'size')).width === 900);
    const { projection } = await camera_at_rest(page);
    assert.ok(Math.abs(projection[5] / projection[0] - 900 / 500) < 1e-6, 'square pixels');
  }),
);

test('pause, step, reset, gravity and the view’s keys and buttons do what they say', bounded, () =>
  with_page({}, async (page, script) => {
    const state = () => script.query('state');
    const becomes = (what, told) => until(async () => told(await state()), what);
    const press = async (name) => {
      await show_controls(page);
      await page.getByRole('button', { name, exact: true }).click();
    };
    const key = async (name) => {
      await page.locator('#view').focus();
      await page.keyboard.press(name);
    };
    // The page's own state, for the next press goes by it.
    const paused = (wanted) =>
      until(async () => (await read(page, 'paused')) === wanted, wanted ? 'it pauses' : 'it goes on');
    await press('Pause');
    await paused(true);
    await key(' ');
    await paused(false);
    await key(' ');
    await paused(true);
    const { tick: before } = await state();
    await press('One step');
    await becomes('the button makes a step', ({ tick }) => tick === before + 1);
    await key('.');
    await becomes('the key makes one too', ({ tick }) => tick === before + 2);
    await press('Reset');
    await becomes('the scene is at its start', ({ tick }) => tick === 0);
    await page.getByRole('slider', { name: 'Gravity' }).focus();
    await page.keyboard.press('Home');
    await becomes('there is no gravity', ({ gravity }) => Math.hypot(...gravity) === 0);
    await until(async () => (await read(page, 'tick')) === 0, 'the page shows the start');
    await key('f');
    const eye = async () => (await camera_at_rest(page)).position;
    const away = (one, other) => Math.hypot(...one.map((part, axis) => part - other[axis]));
    const home = await eye();
    for (const [act, back] of [['ArrowLeft', () => key('f')], ['+', () => press('Frame the cloth')]]) {
      await key(act);
      assert.ok(away(await eye(), home) > 0.05, `${act} moves the view`);
      await back();
      await until(async () => away(await eye(), home) < 0.002, 'it is framed again');
    }
    await script.set({ gravity: [0, -9.81, 0] });
  }),
);

test('the button that pauses says by its name alone what it does, and looks other while time stands', bounded, () =>
  with_page({}, async (page, script) => {
    const pause = page.locator('#pause');
    const [running, standing] = ['.when-running', '.when-paused'].map((part) => pause.locator(part));
    for (const [name, seen, unseen] of [['Pause', running, standing], ['Resume', standing, running]]) {
      await until(async () => (await pause.getAttribute('aria-label')) === name, name);
      assert.equal(await pause.getAttribute('aria-pressed'), null, 'a state would say the same again');
      assert.ok((await seen.isVisible()) && (await unseen.isHidden()), name);
      await script.pause();
    }
  }),
);

test('a frame is around what is typed into, and not around sliders', bounded, () =>
  with_page({ width: 1280, height: 700 }, async (page) => {
    const borders = (selector) =>
      page.locator(selector).evaluateAll((all) => all.map((one) => getComputedStyle(one).borderTopWidth));
    assert.deepEqual(new Set(await borders('label.field')), new Set(['0px']));
    assert.deepEqual(new Set(await borders('input.field')), new Set(['1px']));
  }),
);

const scene_title = (page) => page.locator('#scene-title').textContent();

test('another scene is shown when one is chosen, and R starts it anew', bounded, () =>
  with_page({}, async (page, script) => {
    const other = await open_page(browser, server.url, { name: 'Ben' });
    await page.getByRole('button', { name: 'Scenes' }).click();
    const list = page.getByRole('dialog', { name: 'Scenes' });
    await until(() => list.isVisible(), 'it is fetched and opened');
    const known = (await (await fetch(new URL('api/v1/scenes', server.url))).json()).scenes;
    await until(async () => (await list.locator('#scene-list li').count()) === known.length, 'all are listed');
    for (const { description } of known) assert.ok(await list.getByText(description).isVisible());
    const chosen = list.locator('[aria-current]');
    assert.match(await chosen.textContent(), /^Default/);
    await page.keyboard.press('ArrowDown');
    const focused = () => page.evaluate(() => document.activeElement.querySelector('b')?.textContent);
    const at = await focused();
    await script.load('wall');
    await until(async () => /^Wall/.test(await chosen.textContent()), 'the mark moves with the scene');
    assert.ok(at && (await focused()) === at, 'who goes through the list stays there');
    await list.getByRole('button', { name: /^Flag/ }).click();
    assert.ok(!(await list.isVisible()));
    await until(async () => (await read(other, 'scene')) === 'flag', 'the other viewer follows');
    await until(async () => (await scene_title(other)) === 'Flag');
    assert.deepEqual(other.complaints, []);
    await other.context().close();
    await until(async () => (await read(page, 'scene')) === 'flag');
    await until(async () => (await read(page, 'tick')) > 30);
    await script.pause();
    const { tick } = await script.query('state');
    await page.locator('#view').focus();
    await page.keyboard.press('r');
    await until(async () => (await script.query('state')).tick === 0, `it begins anew, after ${tick} ticks`);
    await script.resume();
    const told = () => page.locator('#scene').getAttribute('title');
    await until(async () => /flag/i.test(await told()), 'its sentence is told');
    const cloth = { name: 'cloth', rows: 4, columns: 4 };
    await script.load({ name: 'mine', cloths: [cloth], pins: [{ place: 'corner', corner: 'top_left' }] });
    await until(async () => (await scene_title(page)) === 'Mine');
    assert.equal(await told(), 'Scenes (L)', 'a scene that is not listed has no sentence of another');
    await script.load('default');
    await until(async () => (await read(page, 'scene')) === 'default');
  }),
);

test('who joins a paused room of another scene reads its name in the list', bounded, () =>
  with_server(['--scene', 'wall', '--paused'], async (page) => {
    await page.getByRole('button', { name: 'Scenes' }).click();
    await until(() => page.locator('#scene-list li').count(), 'the list has come');
    await until(async () => (await scene_title(page)) === 'Wall');
    assert.match(await page.locator('#scene-list [aria-current]').textContent(), /^Wall/);
  }),
);

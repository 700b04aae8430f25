import assert from 'node:assert/strict';
import test from 'node:test';
import { done, open_page, read, until } from './support/browser.mjs';
import { browser, server, with_page } from './support/default_page.mjs';
import { bounded, show_controls } from './support/default_scene.mjs';
import { import_page_module } from './support/page_module.mjs';

// What the page tells of time, strain and energy.

const { EnergyHistory, energy_text } = await import_page_module('panel/energy_history');
const { POWERS_OF_TWO } = await import_page_module('panel/slider');

test('ten seconds of energy are kept, heights count from the lowest, and a reset begins anew', () => {
  const history = new EnergyHistory();
  const energy = (kinetic, gravity) => ({ kinetic, stretch: 2, bending: 1, gravity, total: 0 });
  for (let second = 0; second <= 25; second++) history.add(second, energy(0.5, 100 - second));
  const { moments, largest } = history.shown();
  assert.deepEqual([moments[0].time, moments.at(-1).time], [15, 25]);
  assert.deepEqual([moments[0].height, moments.at(-1).height], [10, 0]);
  assert.deepEqual([moments[3].motion, moments[3].fabric, largest], [0.5, 3, 10]);
  history.add(25, energy(7, 75));
  assert.equal(history.shown().moments.length, 11, 'a moment that is told again replaces itself');
  assert.equal(history.shown().moments.at(-1).motion, 7);
  history.add(0, energy(0, 100));
  assert.deepEqual(history.shown().moments.map(({ time }) => time), [0]);
});

test('energies and speeds are written with units that suit them', () => {
  assert.equal(energy_text(12.34), '12.3 J');
  assert.equal(energy_text(0.01234), '12.3 mJ');
  assert.equal(energy_text(4.2e-6), '4.20 µJ');
  const { text, value, place } = POWERS_OF_TWO;
  assert.deepEqual([text(1 / 32), text(0.5), text(1), text(4)], ['1/32 ×', '1/2 ×', '1 ×', '4 ×']);
  assert.equal(text(0.3), '0.30 ×');
  for (let at = -5; at <= 2; at++) assert.equal(place(value(at)), at);
});

test('the speed of time is set from 1/32 to 4 by slider and keys, and shown to all', bounded, () =>
  with_page({}, async (page, script) => {
    const speed = async () => (await script.query('state')).speed;
    await show_controls(page);
    const slider = page.getByRole('slider', { name: 'Speed' });
    // The page's slider too, for the next key goes by it; older news of the server may come to it last.
    const becomes = async (wanted) => {
      await until(async () => (await speed()) === wanted, `speed ${wanted}`);
      await done(page);
      const text = POWERS_OF_TWO.text(wanted);
      await until(async () => (await slider.getAttribute('aria-valuetext')) === text, `it shows ${text}`);
    };
    await slider.focus();
    await page.keyboard.press('Home');
    await becomes(1 / 32);
    await page.keyboard.press('End');
    await becomes(4);
    await page.locator('#view').focus();
    for (const wanted of [2, 1, 0.5]) {
      await page.keyboard.press('<');
      await becomes(wanted);
    }
    await page.keyboard.press('>');
    await becomes(1);
    await script.speed(0.25);
    await becomes(0.25);
    assert.equal(await page.locator('#speed-value').textContent(), '1/4 ×');
    await script.speed(1);
  }),
);

test('figures open and close by button and key, and stay as they were left', bounded, async () => {
  const page = await open_page(browser, server.url, { width: 1600, height: 720 });
  const script = await server.script();
  const chart = page.locator('#energy-chart');
  assert.ok(await chart.isVisible(), 'on a wide screen they are open');
  await until(async () => (await script.query('state')).strain.largest > 0, 'the cloth is strained');
  await until(async () => /up to [\d.]+ %$/.test(await page.locator('#strain').textContent()));
  await until(async () => /^[\d.]+ [mµ]?J$/.test(await page.locator('#energy-motion').textContent()));
  const colours = () =>
    chart.evaluate((canvas) => {
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      const seen = new Set();
      for (let i = 0; i < data.length; i += 4) {
        if (data[i + 3] === 255) seen.add(`${data[i]},${data[i + 1]},${data[i + 2]}`);
      }
      return seen.size;
    });
  await until(async () => (await colours()) >= 3, 'three lines are drawn');
  await page.keyboard.press('i');
  assert.ok(!(await chart.isVisible()));
  await page.reload();
  await until(() => page.evaluate(() => window.weft?.tick >= 0));
  assert.ok(!(await chart.isVisible()), 'as it was left');
  await page.getByRole('button', { name: 'Figures' }).click();
  assert.ok(await chart.isVisible());
  script.close();
  assert.deepEqual(page.complaints, []);
  assert.equal(await read(page, 'phase'), 'open');
  await page.context().close();
});

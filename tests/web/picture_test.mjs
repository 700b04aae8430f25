import assert from 'node:assert/strict';
import test from 'node:test';
import { isDeepStrictEqual } from 'node:util';
import { camera_at_rest, next_pictures, pixel_of, read, until } from './support/browser.mjs';
import { with_page, with_server } from './support/default_page.mjs';
import { bounded, shows_last_tick } from './support/default_scene.mjs';
import { import_page_module } from './support/page_module.mjs';
import { brightness_at, compare, drawn_cloth, projected_cloth } from './support/silhouette.mjs';

// What the page draws.

const { inner_offset } = await import_page_module('view/normals');

/** The cloth of the page's picture and of the server's positions, from where the page looks. */
async function silhouettes(page, script) {
  await shows_last_tick(page, script);
  const { values } = await script.query('positions', { format: 'f64' });
  const camera = await camera_at_rest(page);
  await until(() => read(page, 'fine'), 'the still picture is a fine one');
  const { announcement, data } = script.mesh;
  // The page draws objects thinner by the cloth's thickness.
  const [{ thickness }] = announcement.cloths;
  const objects = data.colliders.map(({ positions, triangles }) => ({
    positions: inner_offset(positions, triangles, thickness),
    triangles,
  }));
  const size = await read(page, 'size');
  const cloth = { positions: values, triangles: data.triangles };
  const expected = projected_cloth(camera, size, cloth, objects);
  return compare(await drawn_cloth(page), expected, size.width);
}

async function turn_view(page, pixels) {
  await page.mouse.move(600, 300);
  await page.mouse.down();
  await page.mouse.move(600 + pixels, 300);
  await page.mouse.up();
  await page.mouse.move(1, 1);
}

test('the cloth that is drawn is the projection of the positions of the server', bounded, () =>
  with_page({ width: 720, height: 540, simple: false }, async (page, script) => {
    for (const turn of [0, -160]) {
      await turn_view(page, turn);
      await script.pause();
      const { overlap, area } = await silhouettes(page, script);
      assert.ok(overlap >= 0.98, `turned by ${turn} pixels: ${overlap}`);
      assert.ok(area > 12_000, `the cloth is in the picture: ${area} pixels`);
      await script.resume();
    }
  }),
);

// A pixel on the outline belongs to whoever has more of it, so that about one in five of them differs
// between two ways of drawing. Seen almost edge-on a cloth is little more than its outline, and its
// overlap falls to 0.95 though nothing is out of place. What is tested there is that
// pixels differ on the outline alone, and no more of them than anywhere else.
test('a cloth seen edge-on differs from its projection on the outline alone', bounded, async () => {
  const seen = [];
  for (const azimuth of [1.4, 1.47]) {
    const view = [0, 1, 0, Math.sin(azimuth), 0.2, Math.cos(azimuth), 1];
    await with_page({ width: 720, height: 540, view, paused: true, simple: false }, async (page, script) => {
      await script.advance(60);
      const { outline, differing, inside, area } = await silhouettes(page, script);
      assert.equal(inside, 0, `from an azimuth of ${azimuth}`);
      assert.ok(differing < 0.35 * outline, `${differing} of ${outline} pixels of the outline`);
      seen.push(area / outline);
    });
  }
  assert.ok(Math.min(...seen) < 10, `it is seen almost edge-on: ${seen}`);
});

test('no vertex moves while ticks stand still; a step moves them by one tick', bounded, () =>
  with_page({}, async (page, script) => {
    await page.keyboard.press(' ');
    await until(async () => (await script.query('state')).paused);
    await until(() => page.evaluate(() => weft.paused));
    await shows_last_tick(page, script);
    const shown = await read(page, 'positions');
    const { values } = await script.query('positions', { format: 'f32' });
    const off = Math.max(...shown.map((value, i) => Math.abs(value - values[i])));
    assert.ok(shown.length === values.length && off < 1.01e-4, `a coordinate is ${off} m off`);
    const pictures = await read(page, 'pictures');
    for (let i = 0; i < 6; i++) {
      await page.mouse.move(200 + i * 20, 200);
      await next_pictures(page);
      assert.deepEqual(await read(page, 'positions'), shown);
    }
    assert.ok((await read(page, 'pictures')) > pictures, 'pictures were drawn meanwhile');
    const tick = await read(page, 'tick');
    await page.keyboard.press('.');
    await until(async () => (await read(page, 'tick')) === tick + 1);
    assert.notDeepEqual(await read(page, 'positions'), shown);
    await page.keyboard.press(' ');
    await until(async () => (await read(page, 'tick')) > tick + 5);
  }),
);

test('a cloth lies in the light, whichever of its sides is turned to it', bounded, async () => {
  const brightness = [];
  for (const [origin, u] of [['-0.5,1.6,0.15', '1,0,0'], ['0.5,1.6,0.15', '-1,0,0']]) {
    const options = ['--set', `cloth.origin=${origin}`, '--set', `cloth.u=${u}`];
    await with_server(['--scene', 'wall', '--paused', ...options], async (page) => {
      await page.evaluate(() => weft.dress([{ color: '#b0a090', back: '#b0a090' }]));
      await camera_at_rest(page);
      await until(() => read(page, 'fine'));
      brightness.push(await brightness_at(page, await pixel_of(page, [0, 1.1, 0.15])));
    }, { simple: false });
  }
  const ratio = brightness[0] / brightness[1];
  assert.ok(ratio > 0.9 && ratio < 1.1, `${brightness}`);
});

/** Lowest and highest corner of what twelve lines surround, checked to be the edges of a box. */
function box_of_lines(lines) {
  const points = Array.from({ length: lines.length / 3 }, (_, i) => lines.slice(i * 3, i * 3 + 3));
  const low = [0, 1, 2].map((axis) => Math.min(...points.map((point) => point[axis])));
  const high = [0, 1, 2].map((axis) => Math.max(...points.map((point) => point[axis])));
  assert.equal(points.length, 24);
  const seen = new Set();
  for (let i = 0; i < points.length; i += 2) {
    const [a, b] = [points[i], points[i + 1]];
    const along = [0, 1, 2].filter((axis) => a[axis] !== b[axis]);
    assert.ok(along.length <= 1, 'a line runs along one axis');
    for (const point of [a, b]) {
      point.forEach((value, axis) => assert.ok(value === low[axis] || value === high[axis]));
    }
    seen.add(`${a} ${b}`);
  }
  if (low.every((value, axis) => value < high[axis])) assert.equal(seen.size, 12);
  return [...low, ...high];
}

test('the lines of the boxes are the server’s, for each tree and level that is chosen', bounded, () =>
  with_page({ paused: true }, async (page, script) => {
    const trees = await script.query('trees');
    await page.keyboard.press('b');
    const panel = page.getByRole('region', { name: 'Boxes' });
    await until(async () => (await panel.getByRole('option').count()) === trees.length);
    const shown = async (tree, level) => {
      const boxes = await script.query('boxes', { tree, level });
      const text = `${boxes.length} ${boxes.length === 1 ? 'box' : 'boxes'}`;
      await until(async () => (await panel.locator('#box-count').textContent()) === text, text);
      const wanted = boxes.map((box) => box.map(Math.fround));
      // As many lines may still be those of another choice, or of an earlier tick.
      await until(async () => {
        const { lines } = await read(page, 'boxes');
        if (lines.length !== boxes.length * 72) return false;
        const drawn = boxes.map((_, k) => box_of_lines(lines.slice(k * 72, k * 72 + 72)));
        return isDeepStrictEqual(drawn, wanted);
      }, `the lines are those of ${tree}, level ${level}`);
    };
    for (const { tree, levels } of trees) {
      await panel.getByRole('combobox').selectOption(tree);
      for (const level of [0, 3, levels - 1]) {
        await panel.getByRole('slider', { name: 'Level' }).fill(String(level));
        await shown(tree, level);
      }
    }
    await panel.getByRole('combobox').selectOption('particles');
    await panel.getByRole('slider', { name: 'Level' }).fill('2');
    await script.advance(30);
    const { tick } = await script.query('state');
    await until(async () => (await read(page, 'boxes')).tick === tick, 'the boxes follow the cloth');
    await shown('particles', 2);
    await script.load('curtain');
    await until(async () => (await panel.getByRole('option').count()) === 3, 'it has no model');
    await until(async () => (await read(page, 'scene')) === 'curtain');
    await until(async () => (await read(page, 'boxes')).lines.length > 0);
    await page.locator('#view').focus();
    await page.keyboard.press('b');
    await until(async () => (await read(page, 'boxes')).lines.length === 0);
    await script.load('default');
    await until(async () => (await read(page, 'scene')) === 'default');
  }),
);

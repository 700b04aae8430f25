import { project } from './browser.mjs';

/** The page's picture, without panels: its size and four bytes a pixel. */
export async function picture_of(page) {
  const show_panels = (visibility) =>
    page.evaluate((value) => {
      for (const panel of document.querySelectorAll('body > :not(main), #labels')) {
        panel.style.visibility = value;
      }
    }, visibility);
  await show_panels('hidden');
  const png = (await page.screenshot()).toString('base64');
  await show_panels('');
  const blank = await page.context().newPage();
  const picture = await blank.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    const { data, width, height } = context.getImageData(0, 0, image.width, image.height);
    let text = '';
    for (let i = 0; i < data.length; i += 0x8000) {
      text += String.fromCharCode(...data.subarray(i, i + 0x8000));
    }
    return { width, height, text: btoa(text) };
  }, png);
  await blank.close();
  return { ...picture, data: Buffer.from(picture.text, 'base64') };
}

/** The number of the cloth that the page draws in each pixel, from 1 on; 0 where there is none. */
export async function cloths_in_pixels(page) {
  return Buffer.from(await page.evaluate(() => weft.cloth_mask()), 'base64');
}

/** Pixels where the page draws cloth, whatever its colour: 1, and 0 elsewhere. */
export async function drawn_cloth(page) {
  return (await cloths_in_pixels(page)).map((number) => Math.min(1, number));
}

/** Mean red, green and blue of the page's picture, 0 to 255. */
export async function mean_color(page) {
  const { data } = await picture_of(page);
  const sums = [0, 0, 0];
  data.forEach((value, i) => i % 4 < 3 && (sums[i % 4] += value));
  return sums.map((sum) => (sum * 4) / data.length);
}

/** Mean of the colour's parts, 0 to 255, around a pixel. */
export async function brightness_at(page, { x, y }, reach = 4) {
  const { data, width } = await picture_of(page);
  let sum = 0;
  let count = 0;
  for (let row = Math.round(y) - reach; row <= Math.round(y) + reach; row++) {
    for (let column = Math.round(x) - reach; column <= Math.round(x) + reach; column++) {
      for (let part = 0; part < 3; part++) sum += data[(row * width + column) * 4 + part];
      count += 3;
    }
  }
  return sum / count;
}

/**
 * Pixels where the cloth is the nearest of all triangles, by a depth buffer.
 * @param {object} camera, size as the page's probe gives them
 * @param {{positions: ArrayLike<number>, triangles: ArrayLike<number>}} cloth
 * @param {{positions: ArrayLike<number>, triangles: ArrayLike<number>}[]} objects
 */
export function projected_cloth(camera, size, cloth, objects) {
  const depth = new Float64Array(size.width * size.height).fill(Infinity);
  const mask = new Uint8Array(size.width * size.height);
  for (const [mesh, value] of [[cloth, 1], ...objects.map((object) => [object, 0])]) {
    const { positions, triangles } = mesh;
    const points = Array.from({ length: positions.length / 3 }, (_, i) =>
      project(camera, size, positions.slice(i * 3, i * 3 + 3)),
    );
    for (let t = 0; t < triangles.length; t += 3) {
      const corners = [points[triangles[t]], points[triangles[t + 1]], points[triangles[t + 2]]];
      fill_triangle(corners, size, depth, mask, value);
    }
  }
  return mask;
}

function fill_triangle([a, b, c], { width, height }, depth, mask, value) {
  const area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (area === 0) return;
  const first_y = Math.max(0, Math.floor(Math.min(a.y, b.y, c.y)));
  const last_y = Math.min(height - 1, Math.ceil(Math.max(a.y, b.y, c.y)));
  const first_x = Math.max(0, Math.floor(Math.min(a.x, b.x, c.x)));
  const last_x = Math.min(width - 1, Math.ceil(Math.max(a.x, b.x, c.x)));
  for (let row = first_y; row <= last_y; row++) {
    for (let column = first_x; column <= last_x; column++) {
      const [x, y] = [column + 0.5, row + 0.5];
      const v = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / area;
      const w = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / area;
      const u = 1 - v - w;
      if (u < 0 || v < 0 || w < 0) continue;
      const here = u * a.depth + v * b.depth + w * c.depth;
      const pixel = row * width + column;
      if (here >= depth[pixel]) continue;
      depth[pixel] = here;
      mask[pixel] = value;
    }
  }
}

/**
 * Compares what is seen with what is expected.
 * @returns overlap: common pixels as a part of those in either; area and outline: pixels of what is
 *     expected, all and those at its edge; differing: pixels in one alone, and inside: those of them
 *     that are farther than two pixels from the edge
 */
export function compare(seen, expected, width) {
  const on_edge = (pixel, reach) => {
    for (let row = -reach; row <= reach; row++) {
      for (let column = -reach; column <= reach; column++) {
        const other = expected[pixel + row * width + column] ?? 0;
        if (other !== expected[pixel]) return true;
      }
    }
    return false;
  };
  const found = { both: 0, either: 0, area: 0, outline: 0, differing: 0, inside: 0 };
  for (let pixel = 0; pixel < expected.length; pixel++) {
    if (!(seen[pixel] | expected[pixel])) continue;
    found.either += 1;
    found.both += seen[pixel] & expected[pixel];
    found.area += expected[pixel];
    if (expected[pixel] && on_edge(pixel, 1)) found.outline += 1;
    if (seen[pixel] === expected[pixel]) continue;
    found.differing += 1;
    if (!on_edge(pixel, 2)) found.inside += 1;
  }
  return { ...found, overlap: found.both / found.either };
}

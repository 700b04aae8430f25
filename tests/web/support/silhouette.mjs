import { project } from './browser.mjs';

/**
 * Pixels of the page's picture that show the cloth. It is the one thing in the studio with a strong
 * colour; panels are hidden for the picture.
 */
export async function cloth_on_canvas(page) {
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
  const text = await blank.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    let mask = '';
    for (let i = 0; i < data.length; i += 4) {
      const most = Math.max(data[i], data[i + 1], data[i + 2]);
      const least = Math.min(data[i], data[i + 1], data[i + 2]);
      mask += (most - least) / most > 0.45 ? '1' : '0';
    }
    return mask;
  }, png);
  await blank.close();
  return Uint8Array.from(text, Number);
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

/** Common pixels of two masks, as a part of those in either. */
export function overlap(a, b) {
  let both = 0;
  let either = 0;
  for (let i = 0; i < a.length; i++) {
    both += a[i] & b[i];
    either += a[i] | b[i];
  }
  return both / either;
}

// The small pictures of the scene browser, taken in the real page, each of at most 4 kB.
import { mkdir, writeFile } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import { join } from 'node:path';
import { camera_at_rest, open_page, read, until } from './support/browser.mjs';
import { server_at, tick_of } from './support/moments.mjs';

const folder = fileURLToPath(new URL('../../web/picture/scenes/', import.meta.url));
const LARGEST = 4096; // [bytes]
const SIZE = { width: 240, height: 150 }; // of a picture [pixels]
const VIEW = { width: 480, height: 300 }; // of the page that it is made of [pixels]

/** Takes the pictures of scenes by their names, one after the other. */
export async function take_small(browser, scenes) {
  await mkdir(folder, { recursive: true });
  for (const scene of scenes) await take(browser, scene);
}

async function take(browser, scene) {
  const tick = tick_of(scene);
  const server = await server_at(scene, tick);
  try {
    const page = await open_page(browser, server.url, { ...VIEW, simple: false });
    await page.locator('#view').focus();
    await page.keyboard.press('h');
    await page.keyboard.press('f');
    await until(async () => (await read(page, 'tick')) === tick, 'the tick is shown');
    await camera_at_rest(page);
    await until(() => read(page, 'fine'), 'the picture is a fine one');
    await page.evaluate(() => {
      for (const id of ['dock', 'labels']) document.getElementById(id).style.visibility = 'hidden';
    });
    const whole = await page.screenshot();
    const bytes = await reduced(page, whole);
    await writeFile(join(folder, `${scene}.jpg`), bytes);
    console.log(`${scene}.jpg: ${bytes.length} bytes`);
    await page.context().close();
  } finally {
    await server.stop();
  }
}

/** Makes a picture small, as good as fits. @param {Buffer} png */
async function reduced(page, png) {
  const text = await page.evaluate(
    async ([source, { width, height }, largest]) => {
      const image = new Image();
      image.src = source;
      await image.decode();
      const canvas = Object.assign(document.createElement('canvas'), { width, height });
      const context = canvas.getContext('2d');
      context.imageSmoothingQuality = 'high';
      context.drawImage(image, 0, 0, width, height);
      for (let quality = 0.9; quality > 0.1; quality -= 0.04) {
        const [, data] = canvas.toDataURL('image/jpeg', quality).split(',');
        if (atob(data).length <= largest) return data;
      }
      throw new Error('no quality is small enough');
    },
    [`data:image/png;base64,${png.toString('base64')}`, SIZE, LARGEST],
  );
  return Buffer.from(text, 'base64');
}

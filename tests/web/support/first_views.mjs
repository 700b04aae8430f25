import { execFileSync } from 'node:child_process';
import { camera_at_rest, open_page, pixel_of, read, until } from './browser.mjs';
import { fill_of } from './figures.mjs';
import { server_at, tick_of } from './moments.mjs';

const DESKTOP = { width: 1280, height: 800 };

/** Names of the built-in scenes. */
export function scene_names() {
  const listed = execFileSync(process.env.WEFT_PROGRAM, ['scenes', '--json'], { encoding: 'utf8' });
  return JSON.parse(listed).scenes.map(({ name }) => name);
}

/**
 * Looks at a scene as one sees it first, at the moment of its picture.
 * @param {import('playwright-core').Browser} browser
 * @returns {Promise<{cloths: number, fill: number, jaws: {x: number, y: number}[], complaints: string[]}>}
 *     the number of its cloths, the part of the picture that is cloth, 0 to 1, and where the jaws of
 *     grippers are in it, 0 to 1 from its upper left
 */
export async function first_view(browser, scene) {
  const tick = tick_of(scene);
  const server = await server_at(scene, tick);
  try {
    const page = await open_page(browser, server.url, { ...DESKTOP, simple: false, visited: true });
    await until(async () => (await read(page, 'tick')) === tick, 'the tick is shown');
    await camera_at_rest(page);
    const [cloths, fill] = [await read(page, 'cloths'), await fill_of(page)];
    const jaws = (await read(page, 'objects')).filter(({ name }) => name.startsWith('gripper.'));
    const pixels = await Promise.all(jaws.map(({ position }) => pixel_of(page, position)));
    const places = pixels.map(({ x, y }) => ({ x: x / DESKTOP.width, y: y / DESKTOP.height }));
    await page.context().close();
    return { cloths, fill, jaws: places, complaints: page.complaints };
  } finally {
    await server.stop();
  }
}

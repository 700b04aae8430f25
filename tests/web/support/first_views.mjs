import { execFileSync } from 'node:child_process';
import { camera_at_rest, open_page, read, until } from './browser.mjs';
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
 * @returns {Promise<{cloths: number, fill: number, complaints: string[]}>} the number of its cloths,
 *     and the part of the picture that is cloth, 0 to 1
 */
export async function first_view(browser, scene) {
  const tick = tick_of(scene);
  const server = await server_at(scene, tick);
  try {
    const page = await open_page(browser, server.url, { ...DESKTOP, visited: true });
    await until(async () => (await read(page, 'tick')) === tick, 'the tick is shown');
    await camera_at_rest(page);
    const [cloths, fill] = [await read(page, 'cloths'), await fill_of(page)];
    await page.context().close();
    return { cloths, fill, complaints: page.complaints };
  } finally {
    await server.stop();
  }
}

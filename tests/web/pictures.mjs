// Draws scenes in the real page and writes the pictures, with a gallery page of them.
// usage: WEFT_PROGRAM=build/weft node tests/web/pictures.mjs OUTPUT_FOLDER [SCENE[@TICK]]...
import { mkdir, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { camera_at_rest, launch_browser, open_page, read, until } from './support/browser.mjs';
import { start_server } from './support/server.mjs';

const USUAL_TICK = 240;
/** Where a scene shows what it is about at another time. */
const TICKS = { default: 600, 'drape-sphere': 150 };
const VIEWS = {
  desktop: { width: 1280, height: 800 },
  phone: { width: 390, height: 780, touch: true },
};

const [folder, ...asked] = process.argv.slice(2);
if (!folder) throw new Error('usage: pictures.mjs OUTPUT_FOLDER [SCENE[@TICK]]...');
await mkdir(folder, { recursive: true });

const server = await start_server(['--paused']);
const browser = await launch_browser();
try {
  const { scenes } = await (await fetch(new URL('api/v1/scenes', server.url))).json();
  const chosen = asked.length
    ? asked.map((text) => {
        const [name, tick] = text.split('@');
        const scene = scenes.find((each) => each.name === name);
        if (!scene) throw new Error(`no scene '${name}'; there are ${scenes.map((s) => s.name)}`);
        return { ...scene, tick: tick ? Number(tick) : (TICKS[name] ?? USUAL_TICK) };
      })
    : scenes.map((scene) => ({ ...scene, tick: TICKS[scene.name] ?? USUAL_TICK }));
  const pictures = [];
  for (const scene of chosen) pictures.push(...(await draw(scene)));
  await writeFile(join(folder, 'index.html'), gallery(pictures));
  console.log(`${pictures.length} pictures: ${join(folder, 'index.html')}`);
} finally {
  await browser.close();
  await server.stop();
}

/** Brings a scene to its tick and takes it as each kind of viewer sees it. */
async function draw(scene) {
  const script = await server.script();
  await script.load(scene.name);
  await script.pause();
  if (scene.tick > 0) await script.advance(scene.tick);
  script.close(); // or its name would be in the pictures
  const pictures = [];
  for (const [view, options] of Object.entries(VIEWS)) {
    const page = await open_page(browser, server.url, { ...options, name: 'Ada' });
    await until(async () => (await read(page, 'tick')) === scene.tick, 'the tick is shown');
    await camera_at_rest(page);
    await until(() => read(page, 'fine'), 'the picture is a fine one');
    const file = `${scene.name}-${scene.tick}-${view}.png`;
    await page.screenshot({ path: join(folder, file) });
    if (page.complaints.length) throw new Error(`${file}: ${page.complaints.join('; ')}`);
    await page.context().close();
    pictures.push({ ...scene, view, file, ...options });
  }
  return pictures;
}

function gallery(pictures) {
  const escape = (text) =>
    text.replace(/[&<>"]/g, (c) => ({ '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;' })[c]);
  const figures = pictures.map(
    ({ name, tick, view, file, description, width, height }) => `
    <figure class="${view}">
      <a href="${file}"><img src="${file}" width="${width}" height="${height}" loading="lazy"
        alt="${escape(`${name} at tick ${tick}, ${view}`)}"></a>
      <figcaption><b>${escape(name)}</b>, tick ${tick}, ${view}. ${escape(description)}</figcaption>
    </figure>`,
  );
  return `<!doctype html>
<html lang="en">
  <meta charset="utf-8">
  <title>Weft: pictures of the scenes</title>
  <style>
    body { font: 15px/1.4 system-ui, sans-serif; margin: 2rem; background: #f4f2ee; color: #26282c; }
    main { display: flex; flex-wrap: wrap; gap: 1.5rem; align-items: flex-start; }
    figure { margin: 0; width: 640px; max-width: 100%; }
    figure.phone { width: 200px; }
    img { width: 100%; height: auto; border-radius: 6px; }
  </style>
  <h1>Weft: pictures of the scenes</h1>
  <main>${figures.join('')}
  </main>
</html>
`;
}

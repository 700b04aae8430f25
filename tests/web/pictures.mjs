// Draws scenes in the real page and writes the pictures, with a gallery page of them.
// usage: WEFT_PROGRAM=build/weft node tests/web/pictures.mjs OUTPUT_FOLDER [SCENE[@TICK]]...
//        The same with --figures measures looks; with --small [SCENE]... it takes the small pictures
// of the scene browser, into web/picture/scenes.
import { execFileSync } from 'node:child_process';
import { mkdir, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { camera_at_rest, launch_browser, open_page, read, until } from './support/browser.mjs';
import { figures_of, print_figures } from './figures.mjs';
import { fill_of } from './support/figures.mjs';
import { take_small } from './small_pictures.mjs';
import { server_at, tick_of } from './support/moments.mjs';

const DESKTOP = { width: 1280, height: 800 };
const PHONE = { width: 390, height: 780, touch: true };
/** Pictures of a scene beside that of the scene by itself: what they show, and what is done for it. */
const EXTRA = {
  default: [
    { view: 'dark', title: 'in the dark theme', options: { ...DESKTOP, dark: true } },
    { view: 'phone', title: 'on a phone', options: PHONE },
    { view: 'phone-dark', title: 'on a phone, in the dark theme', options: { ...PHONE, dark: true } },
    { view: 'boxes', title: 'boxes of the triangles, by level', options: DESKTOP, act: show_boxes },
    { view: 'moving', title: 'in motion, two seconds later', options: DESKTOP, act: go_on, moving: true },
  ],
};
const IN_MOTION = 120; // ticks after which a picture of a moving cloth is taken
/** Figures of the paper that are compared with each other stand in one row. */
const COMPARED_WITH = { 12: 11 };

const [folder, ...asked] = process.argv.slice(2);
if (!folder) throw new Error('usage: pictures.mjs OUTPUT_FOLDER [--figures | --small [SCENE]... | SCENE[@TICK]...]');
if (asked[0] === '--figures') {
  print_figures(await figures_of(folder));
  process.exit();
}
await mkdir(folder, { recursive: true });

const listed = execFileSync(process.env.WEFT_PROGRAM, ['scenes', '--json'], { encoding: 'utf8' });
const { scenes } = JSON.parse(listed);
const browser = await launch_browser();
try {
  const small = asked[0] === '--small';
  if (small) {
    const names = asked.slice(1);
    await take_small(browser, names.length ? names : scenes.map(({ name }) => name));
  } else {
    await take_large();
  }
} finally {
  await browser.close();
}

async function take_large() {
  const chosen = asked.length
    ? asked.map((text) => {
        const [name, tick] = text.split('@');
        const scene = scenes.find((each) => each.name === name);
        if (!scene) throw new Error(`no scene '${name}'; there are ${scenes.map((s) => s.name)}`);
        return { ...scene, tick: tick ? Number(tick) : tick_of(name) };
      })
    : scenes.map((scene) => ({ ...scene, tick: tick_of(scene.name) }));
  const pictures = [];
  for (const scene of chosen) pictures.push(...(await draw(scene)));
  await writeFile(join(folder, 'index.html'), gallery(pictures));
  console.log(`${pictures.length} pictures: ${join(folder, 'index.html')}`);
}

/** Brings a scene to its tick and takes it as viewers see it. */
async function draw(scene) {
  const server = await server_at(scene.name, scene.tick);
  const pictures = [];
  const views = [{ view: 'desktop', title: '', options: DESKTOP }, ...(EXTRA[scene.name] ?? [])];
  for (const { view, title, options, act, moving } of views) {
    const page = await open_page(browser, server.url, { ...options, simple: false, name: 'Ada', visited: true });
    await until(async () => (await read(page, 'tick')) === scene.tick, 'the tick is shown');
    await act?.(page);
    if (!moving) {
      await camera_at_rest(page);
      await until(() => read(page, 'fine'), 'the picture is a fine one');
    }
    const file = `${scene.name}-${scene.tick}-${view}.png`;
    await page.screenshot({ path: join(folder, file) });
    if (page.complaints.length) throw new Error(`${file}: ${page.complaints.join('; ')}`);
    console.log(`${file}: ${Math.round((await fill_of(page)) * 100)} % is cloth`);
    await page.context().close();
    pictures.push({ ...scene, view, title, file, ...options });
  }
  await server.stop();
  return pictures;
}

async function show_boxes(page) {
  await page.keyboard.press('b');
  const panel = page.getByRole('region', { name: 'Boxes' });
  await until(async () => (await read(page, 'boxes')).lines.length > 0, 'boxes are shown');
  await panel.getByRole('slider', { name: 'Level' }).fill('6');
  const shown = panel.locator('#level-value');
  await until(async () => (await shown.textContent()).startsWith('6 of'), 'those of the level');
}

/** Lets time pass: pictures of what moves are smoothed by themselves, not the mean of many. */
async function go_on(page) {
  const begun = await read(page, 'tick');
  await page.getByRole('button', { name: 'Resume' }).click();
  await until(async () => (await read(page, 'tick')) >= begun + IN_MOTION, 'time has passed');
}

/** Number of the paper's figure that a scene shows; null if it shows none. */
function figure_of(name) {
  const number = /^seed-fig(\d+)-/.exec(name)?.[1];
  return number ? (COMPARED_WITH[number] ?? Number(number)) : null;
}

function gallery(pictures) {
  const rows = new Map();
  for (const picture of pictures) {
    const key = figure_of(picture.name) ?? (picture.name.startsWith('seed-') ? 'seed' : 'scenes');
    rows.set(key, [...(rows.get(key) ?? []), picture]);
  }
  const of_seed = [...rows].filter(([key]) => key !== 'scenes');
  const section = (title, parts) =>
    parts.length ? `\n  <h2>${title}</h2>${parts.map(([, row]) => row_of(row)).join('')}` : '';
  return `<!doctype html>
<html lang="en">
  <meta charset="utf-8">
  <meta name="viewport" content="width=device-width, initial-scale=1">
  <title>Weft: pictures of the scenes</title>
  <style>
    body { font: 15px/1.4 system-ui, sans-serif; margin: 2rem auto; padding: 0 1.5rem; max-width: 1400px;
      background: #f4f2ee; color: #26282c; }
    .row { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(480px, 100%), 1fr));
      gap: 1.5rem; align-items: start; margin-bottom: 2rem; }
    figure { margin: 0; }
    img { width: 100%; height: auto; border-radius: 6px; }
    [class^="phone"] img { max-width: 260px; }
  </style>
  <h1>Weft: pictures of the scenes</h1>
  <p>Each is the page itself at the named tick of 1/60 s.</p>${section(
    'Scenes',
    [...rows].filter(([key]) => key === 'scenes'),
  )}${section('The seed’s figures and experiments', of_seed)}
</html>
`;
}

function row_of(pictures) {
  const escape = (text) =>
    text.replace(/[&<>"]/g, (c) => ({ '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;' })[c]);
  const figures = pictures.map(({ name, tick, view, title, file, description, width, height }) => {
    const head = [name, title, `tick ${tick}`].filter(Boolean).join(', ');
    return `
    <figure class="${view}">
      <a href="${file}"><img src="${file}" width="${width}" height="${height}" loading="lazy"
        alt="${escape(head)}"></a>
      <figcaption><b>${escape(head)}.</b> ${escape(description)}</figcaption>
    </figure>`;
  });
  return `\n  <div class="row">${figures.join('')}\n  </div>`;
}

// Measures what cloth looks like on pictures of the page: `./dev pictures --figures`.

import { mkdir } from 'node:fs/promises';
import { join } from 'node:path';
import { launch_browser, open_page, read, until } from './support/browser.mjs';
import {
  colors_in,
  difference,
  highlight_in,
  luma_at,
  picture_of_cloths,
  weave_spacing,
} from './support/figures.mjs';
import { first_view, scene_names } from './support/first_views.mjs';
import { start_server } from './support/server.mjs';

const FABRICS = ['cotton', 'silk', 'denim', 'wool', 'leather', 'nylon'];
const SEVERAL = ['two-flags', 'hard-stack', 'hard-mass-ratio', 'hard-warp-and-weft', 'hard-start-through'];
/** Where cloths of a scene can be told apart, if its own view shows little of some. */
const VIEWS = { 'hard-stack': [-0.22, 0.04, 0.25, -0.35, 0.35, 0.87, 0.06] };
const FOLDED = { scene: 'drape-sphere', tick: 200 };
const PATCH = [0, 1.12, 0.15]; // a place on the scene's cloth, between two stripes [m]
const NEAR = 0.02; // what is shown around it [m]
const DYE = '#7d7d7d';
const BEHIND = [-0.053, 1.171, -0.007, 0.5, 0.2, -0.843, 0.756]; // a view of the default scene, away from the light

/** Pictures of patches, folds and scenes, kept in a folder, and what they show. */
export async function figures_of(folder, only = {}) {
  await mkdir(folder, { recursive: true });
  const server = await start_server(['--paused', '--scene', 'wall']);
  const script = await server.script();
  const browser = await launch_browser();
  const complaints = [];
  const open = async (options) => {
    const page = await open_page(browser, server.url, { width: 480, height: 360, simple: false, ...options });
    return { page, script, folder, end: () => complaints.push(...page.complaints) };
  };
  try {
    const near = await open({ view: [...PATCH, 0, 0, 1, NEAR], width: 640, height: 480 });
    const fabrics = await patches_in(near, only.fabrics ?? FABRICS);
    near.end();
    await near.page.close();
    const studio = await open({});
    await folds_in(studio, fabrics);
    const scenes = await scenes_in(studio, only.scenes ?? SEVERAL, open);
    studio.end();
    const behind = new Map();
    for (const theme of ['light', 'dark']) {
      const seen = await open({ view: BEHIND, dark: theme === 'dark' });
      behind.set(theme, await lumas_behind(seen, theme));
      seen.end();
      await seen.page.close();
    }
    const fills = await fills_in(browser, only.views ?? scene_names());
    return { fabrics, scenes, behind, fills, complaints };
  } finally {
    script.close();
    await browser.close();
    await server.stop();
  }
}

async function keep({ page, folder }, name) {
  const picture = await picture_of_cloths(page);
  await page.screenshot({ path: join(folder, `figure-${name}.png`) });
  return picture;
}

async function show({ page, script }, scene, tick) {
  await script.load(scene);
  await until(async () => (await read(page, 'scene')) === scene, `${scene} is shown`);
  if (tick > 0) await script.advance(tick);
  await until(async () => (await read(page, 'tick')) === tick, `tick ${tick} is shown`);
}

/** Mean colour and spacing of threads [mm] of flat cloth, by fabric. */
async function patches_in(studio, names) {
  const { page } = studio;
  const found = new Map();
  for (const fabric of names) {
    await page.evaluate((look) => weft.dress([look]), { fabric });
    const picture = await keep(studio, `patch-${fabric}`);
    const { lab } = colors_in(picture).get(1);
    found.set(fabric, { lab, spacing: weave_spacing(picture) / (await scale_of(page)) });
  }
  return found;
}

/** Adds the highlights of folds that are all dyed alike, without weave and hem. */
async function folds_in(studio, fabrics) {
  const { page } = studio;
  await show(studio, FOLDED.scene, FOLDED.tick);
  await page.evaluate(() => weft.show_pattern(false));
  for (const [fabric, found] of fabrics) {
    const look = { fabric, color: DYE, back: DYE };
    await page.evaluate((each) => weft.dress([each]), look);
    found.highlight = highlight_in(await keep(studio, `folds-${fabric}`));
  }
  await page.evaluate(() => weft.show_pattern(true));
}

/** Pixels of the picture for a millimetre of the patch. */
async function scale_of(page) {
  const { projection, position } = await read(page, 'camera');
  const { height } = await read(page, 'size');
  const away = Math.hypot(...position.map((value, axis) => value - PATCH[axis]));
  return (projection[5] * height) / 2 / away / 1000;
}

/** The least difference between mean colours of two cloths of a scene. */
async function scenes_in(studio, names, open) {
  const found = new Map();
  for (const name of names) {
    const seen = VIEWS[name] ? await open({ view: VIEWS[name] }) : studio;
    await show(seen, name, 30);
    const colors = [...colors_in(await keep(seen, `cloths-${name}`)).values()];
    if (seen !== studio) await seen.page.close();
    const labs = colors.filter(({ pixels }) => pixels > 40).map(({ lab }) => lab);
    const apart = labs.flatMap((lab, k) => labs.slice(0, k).map((other) => difference(lab, other)));
    found.set(name, { cloths: labs.length, difference: Math.min(...apart) });
  }
  return found;
}

/** Lumas of the folds of the default scene seen from behind, without weave and hem. */
async function lumas_behind(studio, theme) {
  await show(studio, 'default', 600);
  await studio.page.evaluate(() => weft.show_pattern(false));
  const picture = await keep(studio, `behind-${theme}`);
  const [dark, bright] = [0.05, 0.95].map((part) => Math.round(luma_at(picture, part)));
  return { dark, bright, span: bright - dark };
}

/** Parts of first views that are cloth, of scenes of one cloth. */
async function fills_in(browser, names) {
  const found = new Map();
  for (const name of names) {
    const { cloths, fill } = await first_view(browser, name);
    if (cloths === 1) found.set(name, fill);
  }
  return found;
}

export function print_figures({ fabrics, scenes, behind, fills }) {
  console.log('fabric    CIELAB of a patch       highlight   threads [mm]');
  for (const [name, { lab, highlight, spacing }] of fabrics) {
    const color = lab.map((value) => value.toFixed(0).padStart(6)).join('');
    const figures = `${highlight.toFixed(2).padStart(15)}${spacing.toFixed(1).padStart(13)}`;
    console.log(`${name.padEnd(10)}${color}${figures}`);
  }
  const labs = [...fabrics.values()].map(({ lab }) => lab);
  const apart = labs.flatMap((lab, k) => labs.slice(0, k).map((other) => difference(lab, other)));
  console.log(`least difference of two fabrics: ${Math.min(...apart).toFixed(1)} (CIELAB)`);
  for (const [name, { cloths, difference: least }] of scenes) {
    console.log(`${name}: ${cloths} cloths in sight, least difference ${least.toFixed(1)}`);
  }
  for (const [theme, { dark, bright, span }] of behind) {
    console.log(`default from behind, without weave, ${theme} theme: luma ${dark} to ${bright} (p5 to p95), ${span} of 255`);
  }
  const percent = ([name, fill]) => `${name} ${(fill * 100).toFixed(0)} %`;
  console.log(`cloth in first views: ${[...fills].map(percent).join(', ')}`);
}

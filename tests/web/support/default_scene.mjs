import { camera_at_rest, next_pictures, pixel_of, read, until } from './browser.mjs';

// What tests do with a page that shows the default scene, and wait for.

/** Options of a server without wind. */
export const CALM = ['--set', 'environment.wind=0,0,0', '--set', 'environment.gust_speed=0'];
export const COLUMNS = 30; // of the default scene's grid
export const bounded = { timeout: 300_000 };

/** Waits until the page shows the newest tick of a room that stands. */
export const shows_last_tick = (page, script) =>
  until(async () => {
    const { tick } = await script.query('state');
    return (await read(page, 'tick')) === tick;
  }, 'the page shows the last tick');

/**
 * Lets time pass in a room that stands until something holds, and waits until the page shows it. There
 * no hand is lost, however slowly its page draws.
 */
export async function pass(page, script, holds, what = holds.toString()) {
  await until(async () => {
    await script.advance(5);
    return holds();
  }, what);
  await shows_last_tick(page, script);
}

/** Waits until the page's own hands pull where they are drawn, and gives all hands as the server has them. */
export const pulling = (page, script) =>
  until(async () => {
    await next_pictures(page);
    const own = (await read(page, 'hands')).filter((hand) => hand.own);
    const grabs = await script.query('grabs');
    const there = ({ target }) =>
      grabs.some((grab) => Math.hypot(...grab.target.map((value, axis) => value - target[axis])) < 1e-4);
    return own.length > 0 && own.every(there) && grabs;
  }, 'the server pulls where the hands are');

export const position = async (script, particle) => (await script.query('positions'))[particle];

/** Where the page shows a particle of the cloth. */
export async function particle_pixel(page, particle) {
  const positions = await read(page, 'positions');
  return pixel_of(page, positions.slice(particle * 3, particle * 3 + 3));
}

/** A particle near the middle of the cloth, and the mouse upon it. */
export async function point_at_cloth(page, particle = 4 * COLUMNS + 14) {
  await camera_at_rest(page);
  await until(async () => {
    const { x, y } = await particle_pixel(page, particle);
    await page.mouse.move(x, y);
    await next_pictures(page);
    return read(page, 'hovering');
  }, 'the mouse is on the cloth');
  return particle;
}

/** Takes the cloth with the mouse and moves the hand by so many pixels. */
export async function drag_cloth(page, dx, dy) {
  const particle = await point_at_cloth(page);
  const { x, y } = await particle_pixel(page, particle);
  await page.mouse.down();
  await until(async () => (await read(page, 'input')) === 'holding');
  await page.mouse.move(x + dx, y + dy, { steps: 4 });
  return particle;
}

/** Opens the controls that a small screen puts away. */
export async function show_controls(page) {
  const more = page.getByRole('button', { name: 'Controls' });
  if (!(await more.isVisible())) return;
  if ((await more.getAttribute('aria-expanded')) === 'false') await more.click();
}

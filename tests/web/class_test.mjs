import assert from 'node:assert/strict';
import { mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { launch_browser, open_page, read, until } from './support/browser.mjs';
import { point_at_cloth } from './support/default_scene.mjs';
import { start_server } from './support/server.mjs';

// A teacher and a class, each in a browser of its own. WEFT_CLASS says how many pupils there are.

const PUPILS = Number(process.env.WEFT_CLASS ?? 4);
const LEADER = 'operate-0123456789abcdef';
const PUPIL = 'look-0123456789abcdef';
const WALL_RATE = 200_000; // most that the wall is sent [bytes/s]
const MEASURED = Math.max(5, PUPILS); // [s]
const PATIENCE = 30_000 * PUPILS; // until a wall of their rooms has opened, while all of them draw [ms]

/** Of time, as the more copies there are, the less of each a machine can do. */
const SPEED = 2 ** Math.min(0, Math.floor(Math.log2(4 / PUPILS)));

/** One machine draws here what a whole class would: the more pupils, the fewer pictures of each. */
const PUPIL_PAGE = { width: 320, height: 300, interval: 150 * PUPILS };

const press = (page, name) => page.getByRole('button', { name, exact: true }).click();
const each = (pages, act) => Promise.all(pages.map(act));
const told = (page) => page.getByText('You look; an operator can give you a hand.').isVisible();
const in_room = (page, name) =>
  until(async () => (await read(page, 'phase')) === 'open' && (await read(page, 'room')) === name, `it is in ${name}`);

/** Enters one after the other, as more at once would only wait for each other. */
async function enter_all(browser, url) {
  const pupils = [];
  for (let k = 1; k <= PUPILS; k++)
    pupils.push(await open_page(browser, `${url}#token=${PUPIL}`, { ...PUPIL_PAGE, name: `Pupil ${k}` }));
  return pupils;
}

async function open_people(teacher) {
  await teacher.getByRole('list', { name: 'Viewers' }).getByRole('button').first().click();
  await until(() => teacher.getByRole('list', { name: 'People' }).isVisible());
}

/** The teacher says who holds, gives a pupil a hand, and takes it back. */
async function hands_are_given_and_taken(teacher, pupils, script) {
  await open_people(teacher);
  await press(teacher, 'Others watch');
  await each(pupils, (page) => until(() => told(page), 'all are told that they look'));
  const [first] = pupils;
  const hand = teacher.getByRole('checkbox', { name: 'Pupil 1 may hold' });
  await hand.check();
  await until(async () => !(await told(first)), 'the first has a hand');
  const own = await read(first, 'viewer');
  const holders = async () => (await script.query('grabs')).map(({ viewer }) => viewer);
  await point_at_cloth(first);
  await first.mouse.down();
  await until(async () => (await holders()).includes(own), 'it holds the cloth');
  await hand.uncheck();
  await until(async () => (await holders()).length === 0, 'its hand is taken back');
  await first.mouse.up();
  await press(teacher, 'One hand each');
  await each(pupils.slice(1), (page) => until(async () => !(await told(page)), 'the others have a hand each'));
  await hand.check();
  await until(async () => !(await told(first)));
}

async function all_follow(teacher, pupils) {
  await press(teacher, 'Bring all to my view');
  await teacher.keyboard.press('Escape');
  const leader = await read(teacher, 'viewer');
  await each(pupils, (page) => until(async () => (await read(page, 'company')).follows === leader, 'all follow'));
  await teacher.locator('#view').focus();
  for (let k = 0; k < 3; k++) await teacher.keyboard.press('ArrowLeft');
  const eye = async (page) => (await read(page, 'camera')).position;
  await each(pupils, (page) =>
    until(async () => {
      const [a, b] = [await eye(teacher), await eye(page)];
      return Math.hypot(...a.map((x, axis) => x - b[axis])) < 2e-3;
    }, 'all see from the same place'),
  );
}

/** Counts what the sockets of the wall are sent, and what the list of rooms costs. */
function count_wall(teacher) {
  // Where pages starve for the processor a connection may be lost and made anew; rooms are counted.
  const wall = { rooms: new Set(), bytes: 0, texts: 0, frames: 0 };
  teacher.on('websocket', (socket) => {
    if (!socket.url().includes('glance=1')) return;
    wall.rooms.add(new URL(socket.url()).pathname);
    socket.on('framereceived', ({ payload }) => {
      wall.bytes += Buffer.byteLength(payload);
      if (typeof payload === 'string') wall.texts += Buffer.byteLength(payload);
      else wall.frames += 1;
    });
  });
  return wall;
}

/** Opens the wall and measures it while all the rooms move and some pupils hold their cloth. */
async function watch_wall(teacher, pupils, script) {
  const counted = count_wall(teacher);
  await teacher.getByRole('button', { name: /^Room: / }).click();
  await teacher.getByRole('button', { name: 'Wall of pictures' }).click();
  const wall = teacher.getByRole('dialog', { name: 'All rooms' });
  const cells = wall.getByRole('button', { name: /Cloth passes through nothing/ });
  const all_there = async () => (await cells.count()) === PUPILS + 1;
  await until(all_there, 'each room is there with its truth', PATIENCE);
  for (const page of pupils.slice(0, 4)) {
    await point_at_cloth(page);
    await page.mouse.down();
  }
  const before = { ...counted };
  const began = performance.now();
  await sleep(MEASURED * 1000);
  const seconds = (performance.now() - began) / 1000;
  const bytes = counted.bytes - before.bytes;
  const list = JSON.stringify(await script.listRooms()).length;
  const rate = bytes / seconds + list;
  console.log(
    `a wall of ${PUPILS + 1} rooms is sent ${(rate / 1000).toFixed(1)} kB/s: ${((counted.texts - before.texts) / seconds / 1000).toFixed(1)} of state, ` +
      `${(list / 1000).toFixed(1)} of the list, ${counted.frames - before.frames} frames in ${seconds.toFixed(1)} s; ${(before.bytes / 1000).toFixed(0)} kB to open`,
  );
  assert.equal(counted.rooms.size, PUPILS + 1);
  assert.ok(counted.frames > before.frames, 'pictures come');
  assert.ok(rate < WALL_RATE, `${rate} bytes/s`);
  const { rooms } = await script.listRooms();
  for (const { name, viewers } of rooms) if (name !== 'default') assert.equal(viewers, 1, `only the pupil is in ${name}`);
  for (const page of pupils.slice(0, 4)) await page.mouse.up();
  return cells;
}

test(`a class of ${PUPILS} is led, tries for itself, is watched on the wall, and comes back`, { timeout: 2_300_000 }, async () => {
  const folder = await mkdtemp(join(tmpdir(), 'weft-class-'));
  const tokens = join(folder, 'tokens');
  await writeFile(tokens, `viewer ${PUPIL}\noperator ${LEADER} Teacher\n`, { mode: 0o600 });
  const browser = await launch_browser();
  const server = await start_server(['--tokens', tokens, '--max-seconds', '2300']);
  try {
    const script = await server.script('script', { token: LEADER });
    await script.speed(SPEED);
    const teacher = await open_page(browser, `${server.url}#token=${LEADER}`, { width: 900, height: 640 });
    const pupils = await enter_all(browser, server.url);
    await hands_are_given_and_taken(teacher, pupils, script);
    await all_follow(teacher, pupils);
    for (const [k, page] of pupils.entries()) {
      await press(page, 'Try it yourself');
      await in_room(page, `pupil-${k + 1}`);
      await press(page, 'Pause');
      await until(async () => await read(page, 'paused'), 'its maker operates the copy');
      await press(page, 'Resume');
    }
    assert.equal((await script.listRooms()).rooms.length, PUPILS + 1);
    const cells = await watch_wall(teacher, pupils, script);
    await cells.filter({ hasText: 'pupil-1' }).first().press('Enter');
    await in_room(teacher, 'pupil-1');
    await press(teacher, 'Back');
    await in_room(teacher, 'default');
    await each(pupils, async (page) => {
      await press(page, 'Back');
      await in_room(page, 'default');
    });
    for (const page of [teacher, ...pupils]) assert.deepEqual(page.complaints, []);
    script.close();
  } finally {
    await browser.close();
    await server.stop();
    await rm(folder, { recursive: true, force: true });
  }
});

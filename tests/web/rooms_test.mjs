import assert from 'node:assert/strict';
import { mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';
import { camera_at_rest, done, open_page, read, until } from './support/browser.mjs';
import { browser, with_server } from './support/default_page.mjs';
import { bounded, CALM, shows_last_tick } from './support/default_scene.mjs';
import { start_server } from './support/server.mjs';

// Rooms on the page: a copy in one click and back, the list of rooms, and the wall of their pictures.

const in_room = (page, name) =>
  until(async () => (await read(page, 'phase')) === 'open' && (await read(page, 'room')) === name, `it is in ${name}`);
const press = (page, name) => page.getByRole('button', { name, exact: true }).click();
const rooms_of = async (script) => (await script.listRooms()).rooms;
const fragment_of = (page) => new URL(page.url()).hash;

async function open_list(page) {
  await page.getByRole('button', { name: /^Room: / }).click();
  const list = page.getByRole('dialog', { name: 'Rooms' });
  await until(() => list.getByRole('row').nth(1).isVisible(), 'rooms are listed');
  return list;
}

async function open_wall(page) {
  await (await open_list(page)).getByRole('button', { name: 'Wall of pictures' }).click();
  const wall = page.getByRole('dialog', { name: 'All rooms' });
  await until(() => wall.isVisible());
  return wall;
}

test('one click makes a copy of this moment and goes there, and Back leads back, the browser’s too', bounded, () =>
  with_server([...CALM, '--paused'], async (page, script) => {
    await script.advance(40);
    await shows_last_tick(page, script);
    const before = await camera_at_rest(page);
    const here = await script.query('positions');
    await press(page, 'Try it yourself');
    await in_room(page, 'ada');
    await until(async () => (await read(page, 'tick')) === 40, 'the copy is at the same tick');
    const there = await read(page, 'positions');
    const gap = Math.max(...here.flat().map((x, i) => Math.abs(x - there[i])));
    assert.ok(gap < 2e-4, `the copy is ${gap} m off`);
    assert.deepEqual(await camera_at_rest(page), before, 'it is seen from where the first was');
    assert.equal(fragment_of(page), '#room=ada');
    assert.equal(await page.title(), 'ada · Weft');
    assert.ok(await page.getByRole('button', { name: 'Room: ada' }).isVisible());
    await page.locator('#view').focus();
    await page.keyboard.press('r');
    await until(async () => (await read(page, 'tick')) === 0, 'the copy is reset');
    assert.equal((await script.query('state')).tick, 40, 'the first is as it was');
    await press(page, 'Back');
    await in_room(page, 'default');
    await until(async () => (await read(page, 'tick')) === 40);
    assert.equal(fragment_of(page), '');
    assert.ok(!(await page.getByRole('button', { name: 'Back', exact: true }).isVisible()), 'there is nothing behind');
    await page.goForward();
    await in_room(page, 'ada');
    await page.goBack();
    await in_room(page, 'default');
    await page.locator('#view').focus();
    await page.keyboard.press('t');
    await in_room(page, 'ada-2');
    await page.reload();
    await in_room(page, 'ada-2');
    await press(page, 'Back');
    await in_room(page, 'default');
    assert.deepEqual((await rooms_of(script)).map(({ name }) => name), ['ada', 'ada-2', 'default']);
  }, { name: 'Ada' }),
);

test('no copy is made beyond the limit of rooms, and the page says so', bounded, () =>
  with_server([...CALM, '--paused', '--rooms', '2'], async (page, script) => {
    await script.createRoom('one');
    await press(page, 'Try it yourself');
    await until(() => page.getByText('No copy was made: at most 2 rooms at a time').isVisible());
    assert.equal(await read(page, 'room'), 'default');
    assert.equal((await rooms_of(script)).length, 2);
  }),
);

test('a room that is closed, or that there is not, is told, and Back leads to the first', bounded, () =>
  with_server([...CALM, '--paused'], async (page, script) => {
    await press(page, 'Try it yourself');
    await in_room(page, 'ada');
    await script.closeRoom('ada');
    const told = page.getByRole('alert');
    await until(() => told.isVisible());
    assert.match(await told.innerText(), /This room was closed\./);
    await press(page, 'Back');
    await in_room(page, 'default');
    assert.ok(!(await told.isVisible()));
    const lost = await browser.newContext();
    lost.setDefaultTimeout(120_000);
    const other = await lost.newPage();
    const { origin, pathname } = new URL(page.url());
    await other.goto(`${origin}${pathname}#room=nowhere`);
    await until(() => other.getByRole('alert').isVisible(), 'the reason is shown');
    assert.match(await other.getByRole('alert').innerText(), /There is no such room any more\./);
    await press(other, 'Back');
    await in_room(other, 'default');
    await lost.close();
  }, { name: 'Ada' }),
);

test('an operator opens, sees and closes rooms by the list, and goes into one', bounded, () =>
  with_server([...CALM, '--paused'], async (page, script) => {
    const list = await open_list(page);
    await list.getByRole('textbox', { name: 'Name of a new room' }).fill('class-7');
    await list.getByRole('combobox', { name: 'Scene of the new room' }).selectOption('flag');
    await page.keyboard.press('Enter');
    const row = list.getByRole('row', { name: /^Open class-7/ });
    await until(() => row.isVisible(), 'the new room is listed');
    await until(async () => /Flag\s+0\s+0\s+stands while empty/.test(await row.innerText()));
    await list.getByRole('textbox', { name: 'Name of a new room' }).fill('class-7');
    await press(page, 'Open it');
    await until(() => list.getByText('there is a room of this name').isVisible(), 'a refusal is told in the dialog');
    await list.getByRole('button', { name: 'Open class-7' }).click();
    await in_room(page, 'class-7');
    assert.equal(await read(page, 'scene'), 'flag');
    await until(async () => (await read(page, 'tick')) > 3, 'its time passes, for somebody is there');
    await open_list(page);
    const rate = list.getByRole('row', { name: /^Open class-7.*×/ });
    await until(() => rate.isVisible(), 'how fast its time passes is told');
    await script.createRoom('class-8');
    await list.getByRole('button', { name: 'Close class-8' }).click();
    await until(async () => (await rooms_of(script)).length === 2, 'it is closed');
    await until(async () => (await list.getByRole('row').count()) === 3, 'and gone from the list');
    assert.equal(await list.getByRole('button', { name: 'Close default' }).count(), 0);
    await page.keyboard.press('Escape');
  }),
);

test('who may only look neither makes a copy nor opens or closes rooms, and a link keeps the room', bounded, async () => {
  const folder = await mkdtemp(join(tmpdir(), 'weft-rooms-'));
  const tokens = join(folder, 'tokens');
  await writeFile(tokens, 'viewer look-0123456789abcdef Ben\noperator operate-0123456789abcdef Ada\n', { mode: 0o600 });
  const server = await start_server([...CALM, '--paused', '--tokens', tokens]);
  const ada = await open_page(browser, `${server.url}#token=operate-0123456789abcdef`);
  await press(ada, 'Try it yourself');
  await in_room(ada, 'ada');
  assert.match(fragment_of(ada), /^#token=operate-0123456789abcdef&room=ada$/);
  await ada.getByRole('list', { name: 'Viewers' }).getByRole('button').click();
  await ada.getByRole('button', { name: 'Link to look' }).click();
  const field = ada.getByRole('textbox', { name: 'Link to look' });
  await until(() => field.isVisible());
  const guest = await open_page(browser, await field.inputValue());
  await in_room(guest, 'ada');
  assert.ok(await guest.getByRole('button', { name: 'Try it yourself' }).isDisabled());
  await guest.locator('#view').focus();
  await guest.keyboard.press('t');
  await until(() => guest.getByText('You only look: with a hand you can make a copy of your own').isVisible());
  const list = await open_list(guest);
  assert.equal(await list.getByRole('button', { name: /^Close (?!$)/ }).count(), 0);
  assert.ok(!(await list.getByRole('textbox').isVisible()));
  for (const page of [ada, guest]) {
    assert.deepEqual(page.complaints, []);
    await page.context().close();
  }
  await server.stop();
  await rm(folder, { recursive: true, force: true });
});

/** Of a picture of the wall: how much of it is drawn, 0 to 1, and a sum that changes with the picture. */
const picture_of = (canvas) =>
  canvas.evaluate((element) => {
    const { data } = element.getContext('2d').getImageData(0, 0, element.width, element.height);
    let [drawn, sum] = [0, 0];
    for (let i = 0; i < data.length; i += 4) {
      drawn += data[i + 3] > 0 ? 1 : 0;
      sum = (sum * 31 + data[i] + data[i + 1] * 3 + data[i + 2] * 7) % 1000003;
    }
    return { drawn: (drawn * 4) / data.length, sum };
  });

test('the wall shows each room live with its people and its truth, wakes none, and a click enters it', bounded, () =>
  with_server(['--scene', 'flag'], async (page, script) => {
    await script.createRoom('empty');
    await script.createRoom('still', { scene: 'hard-start-through', paused: true });
    const sockets = [];
    page.on('websocket', (socket) => sockets.push(socket));
    const wall = await open_wall(page);
    const cell = (name) => wall.getByRole('button', { name: new RegExp(`^${name} `) });
    await until(async () => (await wall.getByRole('button', { name: /people|person|nobody/ }).count()) === 3, 'all rooms');
    for (const name of ['default', 'empty', 'still'])
      await until(async () => (await picture_of(cell(name).locator('canvas'))).drawn > 0.03, `${name} is painted`);
    await until(async () => /2 people\s+Cloth passes through nothing\s+0 crossings/.test(await cell('default').innerText()));
    assert.match(await cell('empty').innerText(), /nobody there/);
    assert.match(await cell('still').innerText(), /nobody there, paused\s+It began tangled, and comes free/);
    const [tick, pictures] = [await read(page, 'tick'), await read(page, 'pictures')];
    const moving = await picture_of(cell('default').locator('canvas'));
    const standing = await picture_of(cell('empty').locator('canvas'));
    await until(async () => (await picture_of(cell('default').locator('canvas'))).sum !== moving.sum, 'the flag moves');
    await until(async () => (await read(page, 'tick')) > tick + 10);
    assert.equal(await read(page, 'pictures'), pictures, 'the picture behind the wall costs nothing');
    assert.deepEqual(await picture_of(cell('empty').locator('canvas')), standing, 'an empty room stands');
    assert.equal((await rooms_of(script)).find(({ name }) => name === 'empty').tick, 0);
    await script.closeRoom('still');
    await until(async () => (await cell('still').count()) === 0, 'a room that is closed goes');
    assert.equal(sockets.length, 3);
    await cell('empty').focus();
    await page.keyboard.press('Enter');
    await in_room(page, 'empty');
    await until(async () => (await read(page, 'tick')) > 3, 'its time passes now');
    await until(() => sockets.slice(0, 3).every((socket) => socket.isClosed()), 'the wall leaves no socket behind');
    await done(page);
  }),
);

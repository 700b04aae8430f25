import assert from 'node:assert/strict';
import { mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test, { after, before } from 'node:test';
import { camera_at_rest, done, launch_browser, open_page, read, until } from './support/browser.mjs';
import { bounded, CALM, point_at_cloth, show_controls } from './support/default_scene.mjs';
import { start_server } from './support/server.mjs';

// Several people with one cloth: who may hold it, what each points at, and by whose camera they see.

const LOOKER = 'look-0123456789abcdef';
const PUPIL = 'pupil-0123456789abcdef'; // of a whole class
const OPERATOR = 'operate-0123456789abcdef';

let browser;
let folder;
let server;
before(async () => {
  browser = await launch_browser();
  folder = await mkdtemp(join(tmpdir(), 'weft-people-'));
  const tokens = join(folder, 'tokens');
  await writeFile(tokens, `viewer ${LOOKER} Ben\nviewer ${PUPIL}\noperator ${OPERATOR} Ada\n`, { mode: 0o600 });
  server = await start_server([...CALM, '--paused', '--tokens', tokens]);
});
after(async () => {
  await browser?.close();
  await server?.stop();
  await rm(folder, { recursive: true, force: true });
});

const enter = (token) => open_page(browser, `${server.url}#token=${token}`);

/** Two pages, an operator's and a viewer's, which are seen off. */
async function with_two(act) {
  const pages = [await enter(OPERATOR), await enter(LOOKER)];
  try {
    await act(...pages);
    for (const { complaints } of pages) assert.deepEqual(complaints, []);
  } finally {
    for (const page of pages) await page.context().close();
  }
}

async function open_list(page) {
  await page.getByRole('list', { name: 'Viewers' }).getByRole('button').click();
  await until(() => page.getByRole('list', { name: 'People' }).isVisible(), 'the list of people');
}

const close_list = (page) => page.keyboard.press('Escape');

test('an operator says who holds by the list of people, and the page of who may not tells it', bounded, () =>
  with_two(async (ada, ben) => {
    await open_list(ada);
    const told = ben.getByText('You look; an operator can give you a hand.');
    assert.ok(!(await told.isVisible()));
    await ada.getByRole('button', { name: 'Others watch' }).click();
    await until(() => told.isVisible(), 'Ben is told that he looks');
    const hand = ada.getByRole('checkbox', { name: 'Ben may hold' });
    await until(async () => !(await hand.isChecked()));
    await hand.check();
    await until(async () => !(await told.isVisible()), 'Ben may hold');
    await ada.getByRole('button', { name: 'Everybody holds' }).click();
    await ada.getByRole('checkbox', { name: 'Ben may hold' }).uncheck();
    await until(() => told.isVisible(), 'Ben is muted');
    await ada.getByRole('checkbox', { name: 'Ben may hold' }).check();
    await until(async () => !(await told.isVisible()));
    // A viewer has nothing to decide.
    await open_list(ben);
    assert.equal(await ben.getByRole('checkbox').count(), 0);
    assert.ok(!(await ben.getByRole('button', { name: 'Others watch' }).isVisible()));
  }));

/** Scripts that come after two pages. */
const class_of = (count) =>
  Promise.all(Array.from({ length: count }, (_, k) => server.script(`pupil ${k}`, { token: PUPIL })));

test('that everybody holds is shown as pressed only if it is so, and pressing it makes it so', bounded, () =>
  with_two(async (ada) => {
    const everybody = ada.getByRole('button', { name: 'Everybody holds' });
    const one_each = ada.getByRole('button', { name: 'One hand each' });
    const shows = (button, pressed) =>
      until(async () => (await button.getAttribute('aria-pressed')) === pressed, `${pressed}`);
    await open_list(ada);
    await everybody.click(); // who was muted by another test holds again
    const muted = ada.getByRole('checkbox', { name: 'Ben may hold' });
    await muted.check();
    await shows(everybody, 'true');
    await muted.uncheck();
    await shows(everybody, 'mixed');
    assert.ok(await ada.getByText(/^1 of 2 may hold\. Press “Everybody holds”/).isVisible());
    await one_each.click();
    await shows(one_each, 'mixed');
    await shows(everybody, 'false');
    await muted.check();
    await shows(one_each, 'true');
    assert.ok(!(await ada.getByText(/may hold\. Press/).isVisible()));
    await everybody.click();
    await shows(everybody, 'true');
  }));

test('newcomers to a crowd are not counted as holding until an operator lets all hold', bounded, async () => {
  const own = await start_server([...CALM, '--paused', '--tokens', join(folder, 'tokens')]);
  const ada = await open_page(browser, `${own.url}#token=${OPERATOR}`);
  const others = [];
  for (let k = 0; k < 6; k++) others.push(await own.script(`pupil ${k}`, { token: PUPIL }));
  await open_list(ada);
  await until(() => ada.getByText(/^3 of 7 may hold\./).isVisible(), 'it is told');
  const everybody = ada.getByRole('button', { name: 'Everybody holds' });
  assert.equal(await everybody.getAttribute('aria-pressed'), 'mixed');
  await everybody.click();
  await until(async () => (await everybody.getAttribute('aria-pressed')) === 'true', 'all hold');
  assert.deepEqual(ada.complaints, []);
  for (const other of others) other.close();
  await ada.context().close();
  await own.stop();
});

test('everybody in a crowd is in the list, and the last can be muted and given a hand', bounded, () =>
  with_two(async (ada) => {
    const others = await class_of(60);
    await open_list(ada);
    const rows = ada.getByRole('list', { name: 'People' }).getByRole('listitem');
    await until(async () => (await rows.count()) === 62, 'all are listed');
    await ada.getByRole('button', { name: 'Everybody holds' }).click();
    const last = rows.last().getByRole('checkbox');
    await until(() => last.isChecked());
    await last.uncheck();
    const name = await rows.last().locator('.viewer-name').textContent();
    const mute_told = async (hand) => (await others[0].query('roster')).find((one) => one.name === name).hand === hand;
    await until(() => mute_told(false), 'the server has muted it');
    await last.check();
    await until(() => mute_told(true), 'and given it a hand');
    // Scrolled by themselves: the links are in sight as before.
    await ada.getByRole('button', { name: 'Link to look' }).click({ trial: true });
    for (const other of others) other.close();
  }));

test('an operator that may not hold gives itself a hand by one click', bounded, () =>
  with_two(async (ada) => {
    const offer = ada.getByRole('button', { name: 'You look. Give yourself a hand' });
    await open_list(ada);
    assert.ok(!(await offer.isVisible()));
    const own = ada.getByRole('checkbox', { name: 'Ada may hold' });
    // The list is closed before the server has answered.
    await own.evaluate((box) => {
      box.click();
      box.closest('dialog').close();
    });
    await until(() => offer.isVisible(), 'Ada is told what helps');
    assert.ok(!(await ada.getByText('an operator can give you a hand').isVisible()), 'and not to ask somebody else');
    await offer.click();
    await until(async () => !(await offer.isVisible()), 'it goes with the hand');
    await open_list(ada);
    await until(() => own.isChecked(), 'the list shows it');
  }));

test('who only looks is shown neither hint nor ring, and offered no copy, until it has a hand', bounded, () =>
  with_two(async (ada, ben) => {
    await open_list(ada);
    const hand = ada.getByRole('checkbox', { name: 'Ben may hold' });
    await hand.uncheck();
    await until(() => ben.getByText('You look; an operator can give you a hand.').isVisible(), 'Ben only looks');
    const offered = async () => {
      await point_at_cloth(ben);
      return {
        hint: await ben.getByText(/^Take the cloth: /).isVisible(),
        ring: (await read(ben, 'ring')).points.length > 0,
        cursor: await ben.locator('#view').getAttribute('data-cursor'),
        copy: await ben.getByRole('button', { name: 'Try it yourself' }).isEnabled(),
      };
    };
    assert.deepEqual(await offered(), { hint: false, ring: false, cursor: '', copy: false });
    assert.match(await ben.locator('#copy').getAttribute('title'), /^You only look: with a hand/);
    await ben.keyboard.press('c');
    await until(() => ben.getByText('You only look, and cannot take the cloth').isVisible(), 'no cursor either');
    assert.equal((await read(ben, 'ring')).points.length, 0);
    await hand.check();
    await until(async () => !(await ben.getByText('You look; an').isVisible()), 'Ben has a hand');
    assert.deepEqual(await offered(), { hint: true, ring: true, cursor: 'grab', copy: true });
    assert.match(await ben.locator('#copy').getAttribute('title'), /^A copy of this cloth/);
  }));

test('a refusal is read in full while the controls are open', bounded, () =>
  with_two(async (ada, ben) => {
    const toast = ben.locator('#toast');
    for (const [width, height] of [[1000, 700], [375, 667], [667, 375]]) {
      await ben.setViewportSize({ width, height });
      await until(async () => (await read(ben, 'size')).width === width);
      await show_controls(ben);
      await ben.getByRole('slider', { name: 'Wind' }).focus();
      await ben.keyboard.press('End');
      await until(async () => /may/.test(await toast.textContent()), 'it is told');
      await toast.evaluate((shown) => (shown.hidden = false)); // however slow the test
      const box = await toast.boundingBox();
      assert.ok(box.x >= 0 && box.y >= 0 && box.x + box.width <= width, `within ${width} x ${height}`);
      // Without the round corners.
      const clip = { x: box.x + 12, y: box.y + 2, width: box.width - 24, height: box.height - 4 };
      const shown = await ben.screenshot({ clip });
      const rest = ben.locator('#top, #toolbar');
      const show_rest = (value) =>
        rest.evaluateAll((all, visibility) => all.forEach(({ style }) => Object.assign(style, { visibility })), value);
      await show_rest('hidden');
      const bare = await ben.screenshot({ clip });
      await show_rest('');
      assert.ok(shown.equals(bare), `nothing lies over it in ${width} x ${height}`);
    }
  }));

test('a control whose command is refused shows the value of the server again', bounded, () =>
  with_two(async (ada, ben) => {
    await show_controls(ben);
    for (const [name, key] of [['Wind', 'End'], ['Gravity', 'Home'], ['Speed', 'Home']]) {
      const slider = ben.getByRole('slider', { name });
      const shown = async () => [await slider.getAttribute('aria-valuetext'), await slider.inputValue()];
      const before = await shown();
      await slider.focus();
      await ben.keyboard.press(key);
      await until(() => ben.locator('#toast').isVisible(), 'the refusal is told');
      await done(ben);
      await until(async () => String(await shown()) === String(before), `${name} is as it was`);
    }
  }));

test('what the server tells right after a slider was moved is shown', bounded, () =>
  with_two(async (ada) => {
    const script = await server.script('script', { token: OPERATOR });
    const before = await script.query('state');
    await show_controls(ada);
    const wind = ada.getByRole('slider', { name: 'Wind' });
    await wind.focus();
    await ada.keyboard.press('End');
    await until(async () => Math.abs(Math.hypot(...(await script.query('state')).wind) - 10) < 1e-6, 'it is moved');
    await script.set({ wind: [3, 0, 0] });
    await until(async () => (await wind.getAttribute('aria-valuetext')) === '3.0 m/s', 'the value of another');
    await script.set({ wind: before.wind });
    script.close();
  }));

test("another's cursor is drawn on the cloth with a name", bounded, () =>
  with_two(async (ada, ben) => {
    await point_at_cloth(ben);
    const cursors = await until(async () => {
      const { cursors } = await read(ada, 'company');
      return cursors.length > 0 && cursors;
    }, "Ben's cursor");
    assert.equal(cursors[0].name, 'Ben');
    const positions = await read(ada, 'positions');
    const gaps = [];
    for (let i = 0; i < positions.length; i += 3)
      gaps.push(Math.hypot(...[0, 1, 2].map((axis) => positions[i + axis] - cursors[0].place[axis])));
    assert.ok(Math.min(...gaps) < 0.03, 'it lies on the cloth');
    await ben.mouse.move(2, 2);
    await until(async () => (await read(ada, 'company')).cursors.length === 0, 'it goes with the mouse');
  }));

const eye = async (page) => (await read(page, 'camera')).position;
const apart = async (one, other) => {
  const [a, b] = [await eye(one), await eye(other)];
  return Math.hypot(...a.map((x, axis) => x - b[axis]));
};
const follows = (page) => read(page, 'company').then((company) => company.follows);

test('whom a camera that rests is shown to sees it at once, among many and as a newcomer too', bounded, () =>
  with_two(async (ada, ben) => {
    const others = [];
    for (let k = 0; k < 12; k++) others.push(await server.script(`pupil ${k}`, { token: LOOKER }));
    await ada.locator('#view').focus();
    for (let k = 0; k < 3; k++) await ada.keyboard.press('ArrowLeft');
    await camera_at_rest(ada);
    assert.ok((await apart(ada, ben)) > 0.1);
    await open_list(ada);
    await ada.getByRole('button', { name: 'Bring all to my view' }).click();
    await until(async () => (await apart(ada, ben)) < 2e-3, 'Ben sees what Ada sees');
    const carl = await enter(LOOKER);
    assert.ok((await apart(ada, carl)) > 0.1, 'who comes later sees by its own');
    await open_list(carl);
    await carl.getByRole('button', { name: 'Follow Ada' }).click();
    await until(async () => (await apart(ada, carl)) < 2e-3, 'until it follows');
    assert.deepEqual(carl.complaints, []);
    await carl.context().close();
    for (const other of others) other.close();
  }));

test('a page that follows sees what the other sees, until its viewer touches it', bounded, () =>
  with_two(async (ada, ben) => {
    await open_list(ada);
    await ada.getByRole('button', { name: 'Bring all to my view' }).click();
    await close_list(ada);
    await until(async () => (await follows(ben)) === (await read(ada, 'viewer')), 'Ben is brought along');
    const box = await ada.locator('#view').boundingBox();
    await ada.mouse.move(box.x + 8, box.y + box.height / 2);
    await ada.mouse.down();
    await ada.mouse.move(box.x + 90, box.y + box.height / 2 + 20, { steps: 6 });
    await ada.mouse.up();
    await until(async () => (await apart(ada, ben)) < 2e-3, 'both see from the same place');
    await ben.mouse.move(box.x + 8, box.y + box.height / 2);
    await ben.mouse.wheel(0, -300);
    await until(async () => (await follows(ben)) === 0, 'Ben has left');
    await until(async () => (await apart(ada, ben)) > 0.02, 'and sees by his own');
  }));

test('a link that an operator makes lets its guest look, and shows as a QR code', bounded, async () => {
  const ada = await enter(OPERATOR);
  try {
    await open_list(ada);
    await ada.getByRole('button', { name: 'Link to look' }).click();
    const field = ada.getByRole('textbox', { name: 'Link to look' });
    await until(() => field.isVisible());
    const link = await field.inputValue();
    assert.ok(link.startsWith(`${server.url}#token=`));
    assert.ok(!link.includes(OPERATOR));
    const code = ada.getByRole('img', { name: 'QR code of the link to look' });
    const { width, height } = await code.locator('svg').boundingBox();
    assert.ok(width > 100 && Math.abs(width - height) < 1);
    const guest = await open_page(browser, link);
    await until(() => guest.getByText('You look; an operator can give you a hand.').isVisible());
    assert.deepEqual(guest.complaints, []);
    await guest.context().close();
    assert.deepEqual(ada.complaints, []);
  } finally {
    await ada.context().close();
  }
});

test('a link that an operator made is shown no more in another room', bounded, async () => {
  const ada = await enter(OPERATOR);
  try {
    const field = ada.getByRole('textbox', { name: 'Link to look' });
    const in_room = (name) =>
      until(async () => (await read(ada, 'phase')) === 'open' && (await read(ada, 'room')) === name, name);
    const make_link = async () => {
      await ada.getByRole('button', { name: 'Link to look' }).click();
      await until(() => field.isVisible(), 'the link');
      return new URLSearchParams(new URL(await field.inputValue()).hash.slice(1)).get('room');
    };
    await open_list(ada);
    assert.equal(await make_link(), null, 'it leads to the first room');
    await close_list(ada);
    await ada.getByRole('button', { name: 'Try it yourself' }).click();
    await in_room('ada');
    await open_list(ada);
    await until(async () => (await field.count()) === 0, 'it is gone');
    assert.equal(await make_link(), 'ada');
    await ada.goBack();
    await in_room('default');
    await until(async () => (await field.count()) === 0, 'it is gone, though the list was open');
    assert.deepEqual(ada.complaints, []);
  } finally {
    await ada.context().close();
  }
});

test('without a token the page says what is missing, and does not try again', bounded, async () => {
  const context = await browser.newContext();
  const page = await context.newPage();
  await page.goto(server.url);
  await until(() => page.locator('#refusal-hint').isVisible(), 'the reason is shown');
  assert.match(await page.locator('#refusal').innerText(), /link/);
  assert.equal(await page.locator('#connection-text').innerText(), 'Refused');
  await context.close();
});

test('a link that is pasted into the address of a page that is not let in lets it in', bounded, async () => {
  const context = await browser.newContext();
  const page = await context.newPage();
  const own = (name) =>
    until(() => page.getByRole('list', { name: 'Viewers' }).getByRole('button', { name }).isVisible(), `it is ${name}`);
  await page.goto(`${server.url}?light=simple`);
  const told = page.getByRole('alert');
  await until(() => told.isVisible(), 'the page is not let in');
  await page.goto(`${server.url}?light=simple#token=${LOOKER}`); // the same document
  await own('Ben');
  assert.ok(!(await told.isVisible()), 'nothing is missing any more');
  await page.goto(`${server.url}?light=simple#token=${OPERATOR}`);
  await own('Ada');
  await context.close();
});

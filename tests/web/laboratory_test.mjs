import assert from 'node:assert/strict';
import test from 'node:test';
import { done, next_pictures, read, until } from './support/browser.mjs';
import { with_server } from './support/default_page.mjs';
import { bounded } from './support/default_scene.mjs';
import { import_page_module } from './support/page_module.mjs';
import { start_server } from './support/server.mjs';

// The textile tests: marks in the picture, and figures beside it.

const { marks_of, overhang, shadow } = await import_page_module('view/textile_marks');
const { ruler } = await import_page_module('view/ruler');
const { LaboratoryPanel, test_of } = await import_page_module('panel/laboratory_panel');
const { measurement_text } = await import_page_module('panel/laboratory_figures');

const DISC = Math.PI * 0.09 ** 2; // of the drape test [m²]

test('a server that does not answer at first is asked again until it tells which test a scene is', async () => {
  const part = () => ({ append() {}, replaceChildren() {}, style: { setProperty() {} } });
  globalThis.document = { getElementById: part, createElement: part };
  const answers = [null, { chord_angle_degrees: 41.5 }];
  let asked = 0;
  const query = async () => {
    const answer = answers[asked++];
    if (!answer) throw new Error('busy');
    return answer;
  };
  const tests = [];
  const panel = new LaboratoryPanel({ connected: true, query }, (kind) => tests.push(kind));
  panel.renew();
  await new Promise(setImmediate);
  for (const now of [2, 2.5]) {
    panel.follow(now);
    await new Promise(setImmediate);
  }
  delete globalThis.document;
  assert.deepEqual(tests, [null, 'cantilever']);
  assert.equal(asked, 2, 'and then once a second');
});

/** Runs a scene for so many ticks and gives the specimen, its rest and what the server measures. */
async function specimen_of(scene, ticks) {
  const server = await start_server(['--scene', scene, '--paused']);
  const script = await server.script();
  const { announcement, data } = await until(() => script.mesh);
  await until(() => script.last.pins.length > 0);
  const [cloth] = announcement.cloths;
  const at_rest = { triangles: data.triangles, cloth, pin: script.last.pins[0], floor: 0 };
  await script.advance(ticks);
  const positions = (await script.query('positions')).flat();
  const measured = await script.query('measurements');
  script.close();
  await server.stop();
  return { specimen: { ...at_rest, positions }, rest: { ...at_rest, positions: data.restPositions }, measured };
}

/** Area inside an outline of pairs of points, seen from above [m²]. */
function area(points) {
  let twice = 0;
  for (let i = 0; i < points.length; i += 6) {
    twice += points[i] * points[i + 5] - points[i + 3] * points[i + 2];
  }
  return Math.abs(twice) / 2;
}

/** The largest angle by which a closed outline turns at a point [degrees]. */
function sharpest_turn(points) {
  const directions = [];
  for (let i = 0; i < points.length; i += 6) {
    directions.push(Math.atan2(points[i + 5] - points[i + 2], points[i + 3] - points[i]));
  }
  const turns = directions.map((direction, k) => direction - directions.at(k - 1));
  return Math.max(...turns.map((turn) => Math.abs(Math.atan2(Math.sin(turn), Math.cos(turn))))) * (180 / Math.PI);
}

test('the outline on the floor has the area that the drape coefficient is made of, to 2 points', bounded, async () => {
  const { specimen, rest, measured } = await specimen_of('drape-test', 240);
  const flat = area(shadow(rest));
  assert.ok(Math.abs(flat - Math.PI * 0.15 ** 2) < 0.05 * flat, `${flat}`);
  const coefficient = (100 * (area(shadow(specimen)) - DISC)) / (flat - DISC);
  const told = measured.drape_coefficient_percent;
  assert.ok(told > 20 && told < 95, `${told}`);
  assert.ok(Math.abs(coefficient - told) < 2, `${coefficient} and ${told}`);
  assert.equal(test_of(measured), 'drape');
  for (const outline of [shadow(rest), shadow(specimen)]) {
    assert.ok(outline.length / 6 > 40, 'it is closed, and fine');
    assert.ok(sharpest_turn(outline) < 20, `no stairs are left: ${sharpest_turn(outline)} degrees`);
  }
});

test('the lines of the cantilever have the droop and the angle that the server measures', bounded, async () => {
  const { specimen, measured } = await specimen_of('cantilever-test', 240);
  const { clamp, tip } = overhang(specimen);
  const droop = clamp[1] - tip[1];
  assert.ok(droop > 0.005 && Math.abs(droop - measured.droop_m) < 1e-5, `${droop}, ${measured.droop_m}`);
  const angle = (Math.atan2(droop, Math.hypot(tip[0] - clamp[0], tip[2] - clamp[2])) * 180) / Math.PI;
  assert.ok(Math.abs(angle - measured.chord_angle_degrees) < 0.05, `${angle}`);
  assert.equal(test_of(measured), 'cantilever');
  const marks = marks_of('cantilever', specimen);
  for (let i = 0; i < marks.length; i += 3) {
    const [x, y] = marks.slice(i, i + 2);
    const away = Math.max(clamp[0] - x, x - tip[0], tip[1] - y, y - clamp[1]);
    assert.ok(away < 0.025, `what measures the strip is beside it, not ${away} m away`);
  }
});

test('a ruler has a mark each centimetre, and longer ones at each fifth and tenth', () => {
  const points = ruler([1, 2, 3], [1, 0, 0], [0, 0, 1], 0.3);
  const marks = new Map();
  for (let i = 6; i < points.length; i += 6) {
    const [x, , z, to_x, , to_z] = points.slice(i, i + 6);
    if (z === 3 && to_x === x) marks.set(Math.round((x - 1) * 1000), to_z - z);
  }
  assert.deepEqual([...marks.keys()], Array.from({ length: 31 }, (_, k) => 10 * k));
  assert.ok(marks.get(10) < marks.get(50) && marks.get(50) < marks.get(100));
});

test('measurements are written in the units of a laboratory', () => {
  assert.deepEqual(measurement_text('droop_m', 0.04123), { label: 'Droop', text: '4.12 cm' });
  assert.equal(measurement_text('bending_rigidity_n_m', 1.234e-5).text, '12.34 µN m');
  assert.equal(measurement_text('folds', 6).text, '6');
  assert.equal(measurement_text('published_low_percent', 58), null);
  assert.equal(test_of({}), null);
});

test('a swing that dies has the figures that the server measures, and no marks', bounded, async () => {
  const { specimen, measured } = await specimen_of('decay-test', 240);
  assert.equal(test_of(measured), 'decay');
  assert.deepEqual(marks_of('decay', specimen), []);
  const told = measurement_text('relaxation_time_s', measured.relaxation_time_s);
  assert.equal(told.text, `${(1000 * measured.relaxation_time_s).toFixed(2)} ms`);
  for (const name of Object.keys(measured)) assert.ok(measurement_text(name, measured[name]), name);
});

test('the page shows figures, band and marks of a textile test, and none elsewhere', bounded, () =>
  with_server(['--scene', 'drape-test', '--paused'], async (page, script) => {
    const panel = page.getByRole('region', { name: 'Laboratory' });
    await script.advance(200);
    const { drape_coefficient_percent, published_low_percent } = await script.query('measurements');
    const shown = `${drape_coefficient_percent.toFixed(1)} %`;
    await until(async () => (await panel.textContent()).includes(shown), 'it is asked again');
    const band = `Published: ${published_low_percent.toFixed(0)} to`;
    await until(async () => (await panel.textContent()).includes(band), band);
    await until(async () => (await read(page, 'laboratory')).length > 0, 'the outline is drawn');
    await script.load('cantilever-test');
    await until(async () => (await read(page, 'scene')) === 'cantilever-test');
    await until(async () => /Bending length/.test(await panel.textContent()));
    await until(async () => (await read(page, 'laboratory')).length > 0, 'the angle is drawn');
    await script.load('default');
    await until(() => panel.isHidden());
    await until(async () => (await read(page, 'laboratory')).length === 0, 'no marks are left');
    await until(async () => (await read(page, 'scene')) === 'default');
    await done(page); // by then the page has asked whether this one is a test
    await next_pictures(page);
    assert.deepEqual(await read(page, 'laboratory'), []);
  }),
);

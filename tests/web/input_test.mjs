import assert from 'node:assert/strict';
import test from 'node:test';
import { import_page_module } from './support/page_module.mjs';

// What mouse and fingers mean, on made-up events of a view of 400 by 800 pixels whose upper half is cloth.

const WIDTH = 400;
const HEIGHT = 800;
const CLOTH = { x: 100, y: 200 };
const OTHER_CLOTH = { x: 300, y: 200 };
const BESIDE = { x: 100, y: 600 };
const OTHER_BESIDE = { x: 300, y: 600 };

/** Stands in for the parts of a browser that Input uses; timers run when told to. */
function stand_in() {
  const timers = new Map();
  let count = 0;
  globalThis.window = {
    addEventListener() {},
    setTimeout: (act) => (timers.set(++count, act), count),
    clearTimeout: (id) => timers.delete(id),
  };
  globalThis.document = { addEventListener() {} };
  globalThis.requestAnimationFrame = (act) => act();
  return timers;
}

const timers = stand_in();
const { Input } = await import_page_module('hold/input');

/** An input whose view tells events of the names of pointers, and what it did. */
function view() {
  timers.clear();
  const handlers = {};
  const element = {
    addEventListener: (name, handle) => (handlers[name] = handle),
    focus() {},
    setPointerCapture() {},
    getBoundingClientRect: () => ({ left: 0, top: 0, width: WIDTH, height: HEIGHT }),
    clientHeight: HEIGHT,
  };
  const done = [];
  let changes = 0;
  const log = (name) => (...values) => void done.push([name, ...values]);
  const on_cloth = (hand, point) => point.y > 0;
  const input = new Input(element, {
    take: (hand, point) => on_cloth(hand, point) && (done.push(['take', hand]), true),
    take_object: (hand) => (done.push(['take_object', hand]), true),
    follow: (hand) => done.push(['follow', hand]),
    push: log('push'),
    let_go: log('let_go'),
    pressable: on_cloth,
    press: () => done.push(['press']),
    orbit: log('orbit'),
    pan: log('pan'),
    zoom: log('zoom'),
    changed: () => (changes += 1),
  });
  const tell = (name, id, { x, y }, more = {}) =>
    handlers[name]({
      pointerId: id,
      pointerType: 'touch',
      clientX: x,
      clientY: y,
      button: 0,
      timeStamp: 0,
      preventDefault() {},
      ...more,
    });
  const names = () => done.splice(0).map(([name, value]) => (name === 'take' || name === 'let_go' || name === 'follow' ? `${name} ${value}` : name));
  return { input, done, names, tell, changes: () => changes };
}

test('each finger on the cloth is a hand, which lets go by itself', () => {
  const { input, names, done, tell } = view();
  tell('pointerdown', 2, CLOTH);
  tell('pointerdown', 3, OTHER_CLOTH);
  assert.deepEqual(names(), ['take 2', 'take 3']);
  tell('pointermove', 3, { x: 320, y: 220 });
  assert.deepEqual(names(), ['follow 3']);
  tell('pointerup', 2, CLOTH);
  assert.deepEqual(done.splice(0), [['let_go', 2, true]]);
  assert.equal(input.state, 'holding');
  tell('pointercancel', 3, OTHER_CLOTH);
  assert.deepEqual(done.splice(0), [['let_go', 3, false]]);
  assert.equal(input.state, 'idle');
});

test('a finger beside the cloth pushes what others hold, whichever comes first', () => {
  for (const first of ['hand', 'finger']) {
    const { input, done, tell, changes } = view();
    if (first === 'hand') tell('pointerdown', 2, CLOTH);
    tell('pointerdown', 3, BESIDE);
    if (first === 'finger') tell('pointerdown', 2, CLOTH);
    done.length = 0;
    const before = changes();
    tell('pointermove', 3, { x: 100, y: 500 });
    tell('pointermove', 3, { x: 150, y: 700 });
    assert.equal(changes(), before + 2, 'each asks for a picture, in which the hand follows');
    const [[up, away], [down, near], ...more] = done.splice(0);
    assert.deepEqual([up, down, more], ['push', 'push', []]);
    assert.ok(away > 1 && near < 1, `${away} ${near}`);
    tell('pointerup', 2, CLOTH);
    done.length = 0;
    tell('pointermove', 3, { x: 150, y: 500 });
    assert.deepEqual(done, [], 'it does nothing once nothing is held');
    assert.equal(input.state, 'idle');
    tell('pointerup', 3, BESIDE);
    tell('pointerdown', 3, BESIDE);
    tell('pointermove', 3, { x: 150, y: 500 });
    assert.deepEqual(done.map(([name]) => name), ['orbit'], 'a new finger turns the view');
  }
});

test('two fingers beside the cloth shift and zoom, and the one that stays turns', () => {
  const { names, tell, done } = view();
  tell('pointerdown', 2, BESIDE);
  tell('pointerdown', 3, OTHER_BESIDE);
  tell('pointermove', 3, { x: 340, y: 600 });
  const [[pan, dx, dy], [zoom, factor]] = done.splice(0);
  assert.deepEqual([pan, zoom], ['pan', 'zoom']);
  assert.ok(Math.abs(dx - 20 / HEIGHT) < 1e-12 && dy === 0);
  assert.ok(Math.abs(factor - 200 / 240) < 1e-12);
  tell('pointerup', 3, OTHER_BESIDE);
  tell('pointermove', 2, { x: 120, y: 600 });
  assert.deepEqual(names(), ['orbit']);
});

test('a finger after a tap shifts the view, and after a while turns it again', () => {
  for (const [wait, does] of [
    [200, 'pan'],
    [900, 'orbit'],
  ]) {
    const { names, tell } = view();
    tell('pointerdown', 2, BESIDE);
    tell('pointerup', 2, BESIDE, { timeStamp: 100 });
    tell('pointerdown', 3, BESIDE, { timeStamp: 100 + wait });
    tell('pointermove', 3, { x: 140, y: 620 });
    assert.deepEqual(names(), [does]);
  }
});

test('a finger that rests presses once and does nothing more; one that moves does not', () => {
  const { input, names, tell } = view();
  tell('pointerdown', 2, CLOTH);
  tell('pointermove', 2, { x: 106, y: 204 });
  assert.equal(timers.size, 1, 'a resting finger wanders');
  for (const act of [...timers.values()]) act();
  assert.deepEqual(names(), ['take 2', 'follow 2', 'let_go 2', 'press']);
  tell('pointermove', 2, { x: 200, y: 204 });
  tell('pointerup', 2, CLOTH);
  assert.deepEqual(names(), []);
  tell('pointerdown', 2, CLOTH);
  tell('pointermove', 2, { x: 120, y: 200 });
  assert.equal(timers.size, 0);
  assert.equal(input.state, 'holding');
  tell('pointerup', 2, CLOTH);
  tell('pointerdown', 2, BESIDE);
  assert.equal(timers.size, 0, 'nothing is there to press');
});

test('a hand that lost the cloth does nothing until its pointer comes anew', () => {
  const { input, names, tell } = view();
  tell('pointerdown', 2, CLOTH);
  input.drop(2);
  assert.deepEqual(names(), ['take 2', 'let_go 2']);
  tell('pointermove', 2, BESIDE);
  assert.deepEqual(names(), []);
  tell('pointerup', 2, BESIDE);
  tell('pointerdown', 2, CLOTH);
  assert.deepEqual(names(), ['take 2']);
});

test('a mouse takes by its left button, shifts by another, and hovers where it is', () => {
  const mouse = { pointerType: 'mouse' };
  const { input, names, tell } = view();
  tell('pointermove', 1, CLOTH, mouse);
  assert.deepEqual(input.point.toArray(), [-0.5, 0.5]);
  tell('pointerdown', 1, CLOTH, { ...mouse, button: 2 });
  tell('pointermove', 1, BESIDE, mouse);
  assert.deepEqual(names(), ['pan']);
  tell('pointerup', 1, BESIDE, mouse);
  tell('pointerdown', 1, CLOTH, mouse);
  tell('pointerdown', 1, CLOTH, { ...mouse, button: 2 });
  assert.deepEqual(names(), ['take 1']);
  assert.equal(timers.size, 0, 'a mouse that rests holds on');
  tell('pointerup', 1, CLOTH, mouse);
  tell('pointerdown', 1, BESIDE, { ...mouse, shiftKey: true, ctrlKey: true });
  assert.deepEqual(names(), ['let_go 1', 'take_object']);
});

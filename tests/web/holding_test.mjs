import assert from 'node:assert/strict';
import test from 'node:test';
import { Holding, made_up_room, point, seen_at } from './support/made_up_room.mjs';

// What hands take, move and pin, with a client that keeps what it is asked for.

const sphere = (name, x, z) => {
  const center = [x, 0.9, z];
  return { name, kind: 'sphere', center, radius: 0.1, pivot: center };
};
const box = (name, x, y) => {
  const center = [x, y, 0.5];
  const half_extents = [0.05, 0.02, 0.05];
  return { name, kind: 'box', center, half_extents, orientation: [0, 0, 0, 1], pivot: center };
};
/** Waits for longer than hands wait between two messages [ms]. */
const settled = () => new Promise((done) => setTimeout(done, 60));

/** What was asked for of these commands, and forgets it. */
const asked = (sent, op) => sent.splice(0).filter(([name]) => name === op);

globalThis.window = globalThis;

test('each object is moved by its place in the list, whatever its name', async () => {
  const colliders = [sphere('leg', -0.7, 0), sphere('leg', 0.7, 0), sphere('', -0.3, 0.5), sphere('', 0.3, 0.5)];
  const { reach, sent, orbit } = made_up_room({ colliders });
  const holding = new Holding(reach);
  for (const [place, { center }] of colliders.entries()) {
    const at = seen_at(orbit, center);
    assert.equal(holding.take(1, at), false, 'a plain drag leaves it');
    assert.ok(holding.take_object(1, at));
    holding.follow(1, seen_at(orbit, [center[0], 1.2, center[2]]));
    await settled();
    holding.let_go(1, true);
    const moves = asked(sent, 'move');
    assert.equal(moves.length, 1);
    const [[, what, { position }]] = moves;
    assert.deepEqual(what, { collider: place });
    const goal = [center[0], 1.2, center[2]];
    assert.ok(Math.hypot(...position.map((v, k) => v - goal[k])) < 0.02, `${position}`);
  }
});

test('a hand that moves objects too takes them by a plain drag, but the cloth before them first', () => {
  const colliders = [sphere('front', 0, 0.5), sphere('behind', 0, -0.5)];
  const { reach, sent, orbit } = made_up_room({ colliders });
  reach.moves_objects = () => true;
  const holding = new Holding(reach);
  assert.ok(holding.take(1, seen_at(orbit, [0, 0.9, 0.5])));
  assert.deepEqual(asked(sent, 'drag'), [], 'cloth behind an object cannot be taken');
  assert.ok(holding.take(2, seen_at(orbit, [0.4, 1.4, 0])));
  assert.equal(asked(sent, 'drag').length, 1);
  assert.ok(!holding.take(3, seen_at(orbit, [0.9, 1.8, 0])), 'nothing is there');
});

test('cloth behind an object can neither be taken nor pinned, and nothing hovers there', () => {
  const { reach, sent, orbit } = made_up_room({ colliders: [sphere('front', 0, 0.5)] });
  const holding = new Holding(reach);
  const hidden = seen_at(orbit, [0, 0.9, 0.5]);
  assert.equal(holding.take(1, hidden), false);
  assert.equal(holding.hover(hidden), false);
  holding.toggle_pin(hidden);
  assert.deepEqual(sent, []);
  assert.equal(holding.hover(seen_at(orbit, [0.3, 1.3, 0])), true);
});

test('a gripper is carried by its middle, and a tap closes or opens it', async () => {
  const colliders = [box('gripper.left', 0.2, 0.86), box('gripper.right', 0.2, 0.94), box('other.left', -0.3, 0.9)];
  const grippers = [{ name: 'gripper', opening: 0.06, gripping: false }];
  const { reach, sent, orbit } = made_up_room({ colliders, grippers });
  const holding = new Holding(reach);
  holding.taking.grippers.renew();
  await settled();
  sent.length = 0;
  const jaw = seen_at(orbit, [0.2, 0.86, 0.55]);
  assert.ok(holding.take(1, jaw));
  holding.follow(1, point(jaw.x, jaw.y + 0.2));
  await settled();
  holding.let_go(1, true);
  const [[, name, { position }]] = asked(sent, 'gripper');
  assert.equal(name, 'gripper');
  assert.ok(Math.abs(position[0] - 0.2) < 1e-6 && position[1] > 1, `${position}`);

  for (const [state, wanted] of [
    [{ opening: 0.06, gripping: false }, 0],
    [{ opening: 0.008, gripping: true }, 0.06],
    [{ opening: 0, gripping: false }, 0.06],
  ]) {
    Object.assign(grippers[0], state);
    assert.ok(holding.take(1, jaw));
    holding.let_go(1, true);
    await settled();
    assert.deepEqual(asked(sent, 'gripper'), [['gripper', 'gripper', { opening: wanted }]]);
  }
  assert.ok(!holding.take(1, seen_at(orbit, [-0.3, 0.9, 0.55])), 'a box of such a name is no jaw');
});

test('a hand that is broken off neither closes a gripper nor throws the cloth', async () => {
  const colliders = [box('gripper.left', 0.2, 0.86), box('gripper.right', 0.2, 0.94)];
  const { reach, sent, orbit } = made_up_room({ colliders, grippers: [{ name: 'gripper', opening: 0.06 }] });
  const holding = new Holding(reach);
  holding.taking.grippers.renew();
  await settled();
  assert.ok(holding.take(1, seen_at(orbit, [0.2, 0.86, 0.55])));
  holding.let_go(1, false);
  assert.ok(holding.take(2, seen_at(orbit, [-0.3, 1.3, 0])));
  holding.let_go(2, false);
  await settled();
  const ops = sent.map(([op]) => op);
  assert.ok(!ops.includes('gripper'));
  assert.deepEqual(sent[ops.indexOf('drag end')], ['drag end', { fire: false }]);
});

test('a finger pins and frees within its width, and of several pins the nearest', () => {
  const { reach, sent, orbit, pins } = made_up_room();
  const holding = new Holding(reach);
  const pin = (id, particle, position) => ({ id, particle, position, viewer: 0, radius: 0, count: 1 });
  const corner = [-0.5, 1.5, 0];
  const beside = (pixels) => {
    const { x, y } = seen_at(orbit, corner);
    return point(x - (2 * pixels) / 800, y);
  };
  assert.equal(holding.pressable(1, beside(20)), true, 'the cloth is within reach');
  assert.equal(holding.pressable(1, beside(40)), false);
  holding.press(beside(20));
  assert.equal(asked(sent, 'pin').length, 1);
  pins.set([pin(7, 0, corner), pin(8, 1, [-0.47, 1.5, 0])], () => null);
  for (const pixels of [0, 20]) {
    holding.press(beside(pixels));
    assert.deepEqual(sent.splice(0), [['release', { pin: 7 }]]);
  }
  holding.press(beside(40));
  assert.deepEqual(sent, [], 'nothing is within reach');
});

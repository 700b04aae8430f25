import assert from 'node:assert/strict';
import test from 'node:test';
import { Holding, KeyHand, made_up_room } from './support/made_up_room.mjs';

// The keyboard's hand, with a client that keeps what it is asked for.

function hand_in_room(options) {
  const room = made_up_room(options);
  const holding = new Holding(room.reach);
  return { ...room, holding, hand: new KeyHand(room.reach, holding.pointed, holding) };
}

/** Where the cursor is [m]. */
const place = ({ hand, world }) =>
  [0, 1, 2].map((axis) =>
    hand.cursor.barycentric.reduce((sum, weight, corner) => {
      const vertex = world.triangles[hand.cursor.triangle * 3 + corner];
      return sum + weight * world.playback.positions[vertex * 3 + axis];
    }, 0),
  );

const targets = ({ sent }) =>
  sent.splice(0).flatMap(([op, target]) => (op === 'drag move' ? [target] : []));

test('without a cursor no key of the hand does anything', () => {
  const { hand, sent } = hand_in_room();
  assert.equal(hand.arrow(1, 0, false), false);
  assert.equal(hand.enter(), false);
  assert.equal(hand.escape(), false);
  assert.equal(hand.toggle_pin(), false);
  assert.deepEqual(sent, []);
});

test('the cursor begins in the middle, arrows lead it over the cloth and stop at its edge', () => {
  const room = hand_in_room();
  const { hand, said } = room;
  hand.toggle();
  assert.deepEqual(said, ['Cursor on the cloth']);
  const [x, y] = place(room);
  assert.ok(Math.hypot(x, y - 1) < 0.1, `${x} ${y}`);
  for (let n = 0; n < 5; n++) hand.arrow(1, 0, false);
  const right = place(room);
  assert.ok(right[0] > x + 0.1 && Math.abs(right[1] - y) < 0.01);
  hand.arrow(0, 1, false);
  assert.ok(place(room)[1] > right[1] + 0.01);
  for (let n = 0; n < 60; n++) hand.arrow(-1, 0, false);
  assert.ok(Math.abs(place(room)[0] + 0.5) < 0.02, 'it is at the edge');
  assert.equal(said.at(-1), 'Edge of the cloth');
  hand.toggle();
  assert.equal(hand.cursor, null);
});

test('where no cloth can be seen there is no cursor', () => {
  const wall = { name: 'wall', kind: 'box', center: [0, 1, 1], half_extents: [2, 2, 0.1] };
  const { hand, said } = hand_in_room({
    colliders: [{ ...wall, orientation: [0, 0, 0, 1], pivot: wall.center }],
  });
  hand.toggle();
  assert.equal(hand.cursor, null);
  assert.deepEqual(said, ['No cloth in view']);
});

test('Enter takes hold, arrows move the hand, Shift moves it in depth, Enter lets go', () => {
  const room = hand_in_room();
  const { hand, sent, said } = room;
  hand.toggle();
  const from = place(room);
  hand.enter();
  const [[op, hold, options]] = sent.splice(0);
  assert.equal(op, 'drag');
  assert.deepEqual(hold, { triangle: hand.cursor.triangle, barycentric: hand.cursor.barycentric });
  assert.equal(options.radius, 0.03);
  for (let n = 0; n < 4; n++) hand.arrow(0, 1, false);
  const up = targets(room).at(-1);
  assert.ok(up[1] > from[1] + 0.08 && Math.abs(up[0] - from[0]) < 0.01, `${up}`);
  hand.arrow(0, 1, true);
  hand.arrow(0, 1, true);
  const away = targets(room).at(-1);
  assert.ok(away[2] < up[2] - 0.1, `${away}`);
  for (let n = 0; n < 4; n++) hand.arrow(0, -1, true);
  assert.ok(targets(room).at(-1)[2] > up[2] + 0.1);
  assert.equal(hand.enter(), true);
  assert.deepEqual(sent.splice(0), [['drag end', {}]]);
  assert.deepEqual(said, ['Cursor on the cloth', 'Holding', 'Let go']);
  assert.ok(hand.cursor, 'the cursor stays on the cloth');
});

test('Escape lets go without throwing, and then takes the cursor away', () => {
  const { hand, sent } = hand_in_room();
  hand.toggle();
  hand.enter();
  sent.length = 0;
  hand.escape();
  assert.deepEqual(sent.splice(0), [['drag end', { fire: false }]]);
  hand.escape();
  assert.equal(hand.cursor, null);
  assert.deepEqual(sent, []);
});

test('M pins at the cursor, held or not, and frees what is pinned there', () => {
  const { hand, sent, pins, world, said } = hand_in_room();
  hand.toggle();
  const { triangle, barycentric } = hand.cursor;
  hand.toggle_pin();
  assert.deepEqual(sent.splice(0), [['pin', { triangle, barycentric }]]);
  const corner = barycentric.indexOf(Math.max(...barycentric));
  const particle = world.triangles[triangle * 3 + corner];
  pins.set([{ id: 4, particle, position: [0, 1, 0], viewer: 1, radius: 0, count: 1 }], () => null);
  hand.enter();
  sent.length = 0;
  hand.toggle_pin();
  assert.deepEqual(sent, [['release', { pin: 4 }]]);
  assert.deepEqual(said.filter((text) => /ed$/.test(text)), ['Pinned', 'Freed']);
});

test('without a connection M asks for nothing, and does not say that it has pinned', () => {
  const { hand, reach, sent, said } = hand_in_room();
  hand.toggle();
  reach.client.connected = false;
  const before = said.length;
  assert.equal(hand.toggle_pin(), true, 'the key is the cursor’s all the same');
  assert.deepEqual(sent, []);
  assert.equal(said.length, before);
});

test('a hand that the server takes away leaves the cursor', () => {
  const { hand, holding, sent } = hand_in_room();
  hand.toggle();
  hand.enter();
  sent.length = 0;
  hand.cancel();
  assert.equal(hand.holds, false);
  assert.equal(holding.holds_cloth, false);
  assert.ok(hand.cursor);
  hand.arrow(1, 0, false);
  assert.deepEqual(targets({ sent }), [], 'arrows move the cursor again');
});

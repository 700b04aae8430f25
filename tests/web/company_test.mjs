import assert from 'node:assert/strict';
import test from 'node:test';
import { import_page_module } from './support/page_module.mjs';

// By whose camera a viewer sees, for what a made-up server tells.

const { Company } = await import_page_module('wire/company');

const OWN = 1;
const LEADER = 2;
const OTHER = 3;
const camera = (x) => ({ position: [x, 1, 2], target: [0, 1, 0], up: [0, 1, 0], fov: 45 });

/** A company that keeps what it was made to see; `tell` has it hear a message. */
function in_company() {
  const heard = new Map();
  const seen = [];
  const client = { viewer: OWN, connected: true, on: (name, hear) => heard.set(name, hear), post() {} };
  const company = new Company(client, { see: ({ position: [x] }) => seen.push(x), changed() {} });
  return { company, seen, tell: (name, message) => heard.get(name)(message) };
}

/** All orders of some things. */
function* orders(things) {
  if (things.length < 2) yield things;
  for (const [k, first] of things.entries())
    for (const rest of orders(things.toSpliced(k, 1))) yield [first, ...rest];
}

/** All ways to cut a list into messages. */
function* cuts(list) {
  for (let bits = 0; bits < 2 ** (list.length - 1); bits++) {
    const messages = [[]];
    for (const [k, entry] of list.entries()) {
      messages.at(-1).push(entry);
      if ((bits >> k) & 1) messages.push([]);
    }
    yield messages.filter(({ length }) => length > 0);
  }
}

test('who follows sees the camera last told, in whatever order and messages both are told', () => {
  const entries = [
    { viewer: LEADER, camera: camera(7) },
    { viewer: OWN, follows: LEADER },
    { viewer: OTHER, camera: camera(8), follows: LEADER },
    { viewer: OTHER, cursor: [0, 1, 0] },
  ];
  for (const order of orders(entries))
    for (const messages of cuts(order)) {
      const { seen, tell } = in_company();
      for (const viewers of messages) tell('presence', { viewers });
      assert.deepEqual(seen, [7], JSON.stringify(messages));
    }
});

test('a camera that was told long before is seen when its viewer is followed, again after leaving, and not when gone', () => {
  const { company, seen, tell } = in_company();
  const follow = (viewer) => tell('presence', { viewers: [{ viewer: OWN, follows: viewer }] });
  tell('presence', { viewers: [{ viewer: LEADER, camera: camera(7) }] });
  tell('presence', { viewers: [{ viewer: OTHER, camera: camera(8) }] });
  tell('roster', { viewers: [{ id: OWN }, { id: LEADER }, { id: OTHER }] });
  assert.deepEqual(seen, [], 'none is followed');
  follow(LEADER);
  follow(OTHER);
  company.leave();
  follow(OTHER);
  assert.deepEqual(seen, [7, 8, 8]);
  tell('presence', { viewers: [{ viewer: LEADER, camera: camera(9) }] });
  assert.deepEqual(seen, [7, 8, 8], 'another one moves');
  tell('roster', { viewers: [{ id: OWN }, { id: OTHER }] });
  follow(LEADER);
  assert.deepEqual(seen, [7, 8, 8], 'the camera of one who has left is forgotten');
});

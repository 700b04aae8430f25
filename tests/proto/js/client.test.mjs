import assert from 'node:assert/strict';
import test from 'node:test';

import {
  CallTimeout, CommandError, ConnectionLost, FrameReader, ProtocolError, WeftClient, decodeFrame, decodeMesh,
} from '../../../proto/js/index.js';
import { FakeTimers, fakeSockets, settle } from './fakes.mjs';
import { packedStreams, readGolden, readGoldenJson, specificationExamples } from './golden.mjs';

const examples = specificationExamples();
const example = (op, command) => examples.find((m) => m.op === op && (!command || m.command === command));
const welcome = example('welcome');
const GRID = {
  op: 'mesh', epoch: 1, scene: 'grid', hash: '00', url: '/api/v1/mesh/00', bytes: 224,
  vertices: 6, triangles: 4, cloths: [], colliders: [],
};
const HIT = { triangle: 411, barycentric: [0.25, 0.5, 0.25], position: [0, 1, 0], particle: 222 };

/** A client that has joined, its socket, and the time. */
async function join(options = {}) {
  const { FakeSocket, sockets } = fakeSockets();
  const timers = new FakeTimers();
  const client = new WeftClient('ws://host:1/ws', {
    WebSocket: FakeSocket, timers, random: () => 1, ...options,
  });
  const connected = client.connect();
  sockets[0].open();
  sockets[0].say(welcome);
  await connected;
  return { client, socket: sockets[0], sockets, timers };
}

function answer(socket, op, fields = {}) {
  const { id } = socket.ops(op).at(-1);
  socket.say({ op: 'result', id, command: op, ...fields });
}

test('the subprotocol is asked for and welcome ends the wait', async () => {
  const { client, socket } = await join();
  assert.equal(socket.protocol, 'weft.v1');
  assert.equal(socket.url, 'ws://host:1/ws');
  assert.equal(client.viewer, welcome.viewer);
  assert.equal(client.connected, true);
});

test('the address of the page leads to the socket, and what is none is told with one', async () => {
  const { FakeSocket, sockets } = fakeSockets();
  const options = { WebSocket: FakeSocket, timers: new FakeTimers() };
  const addresses = {
    'http://host:1': 'ws://host:1/ws',
    'https://host/': 'wss://host/ws',
    'ws://host:1': 'ws://host:1/ws',
    'wss://host/weft/ws': 'wss://host/weft/ws',
    'http://host:1/#room=ada': 'ws://host:1/ws/ada',
    'http://host:1/#token=x&room=ada': 'ws://host:1/ws/ada',
    'ws://host:1/ws#room=ada': 'ws://host:1/ws/ada',
    'ws://host:1/ws/ben#room=ada': 'ws://host:1/ws/ben',
  };
  for (const [given, wanted] of Object.entries(addresses)) {
    const client = new WeftClient(given, options);
    const connected = client.connect();
    assert.equal(sockets.at(-1).url, wanted, given);
    client.close();
    await assert.rejects(connected, /closed by this side/);
  }
  for (const url of ['host:1', 'ftp://host/ws', 'ws://host:99999/ws', ''])
    assert.throws(() => new WeftClient(url, options), /ws:\/\/127\.0\.0\.1:8080\/ws/, url);
});

test('where there is no WebSocket, that is told with what to pass', () => {
  const own = globalThis.WebSocket;
  delete globalThis.WebSocket;
  try {
    assert.throws(() => new WeftClient('ws://host:1/ws'), /pass \{ WebSocket \} of the package ws/);
  } finally {
    if (own) globalThis.WebSocket = own;
  }
});

/** The name that a method of the golden calls has in JavaScript. @param {string} name */
const inCamels = (name) => name.replace(/_(\w)/g, (_, letter) => letter.toUpperCase());

test('each call sends the golden command with an id of its own', async () => {
  const { client, socket } = await join();
  const ids = new Set();
  for (const { method, args, options, sends } of readGoldenJson('client_calls.json')) {
    client[inCamels(method)](...args, ...(Object.keys(options).length ? [options] : [])).catch(() => {});
    const { id, ...message } = socket.sent.at(-1);
    assert.deepEqual(message, sends);
    assert.equal(ids.has(id), false);
    ids.add(id);
  }
});

test('a field that a command has not is named, in its parts too, and nothing is sent', async () => {
  const { client, socket } = await join();
  const before = socket.sent.length;
  const fan = { position: [0, 1, 2], direction: [0, 0, -1] };
  const wrong = [
    [() => client.set({ wind: [1, 0, 0], windy: 1 }), /windy/],
    [() => client.set({ fans: [fan, { ...fan, sped: 1 }] }), /sped/],
    [() => client.set({ fabric: { frction: 0.2 } }), /frction/],
    [() => client.view({ hertz: 30 }), /hertz/],
    [() => client.gripper('g', { openning: 0 }), /openning/],
    [() => client.drag({ particle: 7 }, { raduis: 0.05 }), /raduis/],
    [() => client.release({ particel: 7 }), /particel/],
    [() => client.createRoom('mine', { pausd: true }), /pausd/],
    [() => client.fork('mine', { pausd: true }), /pausd/],
  ];
  for (const [call, word] of wrong) await assert.rejects(async () => call(), { name: 'TypeError', message: word });
  assert.equal(socket.sent.length, before);
});

test('a result goes to the call that it answers, in any order', async () => {
  const { client, socket } = await join();
  const first = client.hash();
  const second = client.pause();
  const [{ id: hashId }] = socket.ops('hash');
  const [{ id: pauseId }] = socket.ops('pause');
  socket.say({ op: 'result', id: pauseId, command: 'pause', paused: true });
  socket.say({ op: 'result', id: hashId, command: 'hash', tick: 5, hash: 'ff' });
  assert.equal((await second).paused, true);
  assert.equal((await first).hash, 'ff');
});

test('pick answers the hit or null', async () => {
  const { client, socket } = await join();
  const hit = client.pick([0, 1, 3], [0, 0, -1]);
  answer(socket, 'pick', { hit: HIT });
  assert.deepEqual(await hit, HIT);
  const miss = client.pick([0, 1, 3], [0, 0, 1]);
  answer(socket, 'pick', { hit: null });
  assert.equal(await miss, null);
});

test('a refusal rejects with all that the server says', async () => {
  const { client, socket } = await join();
  const refused = example('error');
  const call = client.speed(99);
  socket.say({ ...refused, id: socket.ops('speed')[0].id });
  await assert.rejects(call, (error) => {
    assert.ok(error instanceof CommandError);
    const { message, code, command, field, value, limit, hint } = error;
    const { op, id, ...rest } = refused;
    assert.deepEqual({ message, code, command, field, value, limit, hint }, rest);
    return true;
  });
});

test('a refusal that nobody waits for is an event', async () => {
  const { client, socket } = await join();
  const heard = client.next('refused');
  socket.say({ op: 'error', code: 'rate_limited', message: 'too fast' });
  assert.equal((await heard).code, 'rate_limited');
});

test('each event of the specification is told, and unknown ones are ignored', async () => {
  const { client, socket } = await join();
  for (const op of ['state', 'roster', 'pins', 'grabs', 'notice', 'bye']) {
    const heard = client.next(op);
    socket.say(example(op));
    assert.deepEqual(await heard, example(op));
  }
  socket.say({ op: 'of the future', x: 1 });
  assert.equal(client.connected, true);
});

test('a mesh and its frames are told, and every frame is acknowledged', async () => {
  const { client, socket } = await join();
  const frames = [];
  client.on('frame', (frame) => frames.push(frame));
  socket.sayBytes(readGolden('frame_hands.bin')); // before its mesh: acknowledged, not told
  assert.equal(frames.length, 0);
  assert.equal(socket.acks.length, 1);
  const mesh = client.next('mesh');
  socket.say(GRID);
  socket.sayBytes(readGolden('mesh_grid.bin'));
  assert.equal((await mesh).data.triangles.length, 12);
  socket.sayBytes(readGolden('frame_hands.bin'));
  assert.equal(frames.length, 1);
  assert.equal(frames[0].positions.length, 18);
  assert.deepEqual([...socket.acks[1]], [4, 1, 0, 0, 255, 255, 255, 255]);
});

test('a frame that an advance observed is told and not acknowledged', async () => {
  const { client, socket } = await join();
  const frames = [];
  client.on('frame', (frame) => frames.push(frame));
  socket.say(GRID);
  socket.sayBytes(readGolden('mesh_grid.bin'));
  socket.sayBytes(readGolden('frame_observed.bin'));
  assert.deepEqual(frames.map(({ observed }) => observed), [true]);
  assert.equal(socket.acks.length, 0);
});

test('a frame of another epoch is acknowledged and not told', async () => {
  const { client, socket } = await join();
  socket.say({ ...GRID, epoch: 2 });
  socket.sayBytes(readGolden('mesh_grid.bin'));
  client.on('frame', () => assert.fail('told'));
  socket.sayBytes(readGolden('frame_hands.bin'));
  assert.equal(socket.acks.length, 1);
});

test('a message that cannot be read ends the connection and it is made anew', async () => {
  const bad = readGolden('frame_hands.bin');
  bad[70] ^= 1;
  const speak = [
    (socket) => socket.sayBytes(bad),
    (socket) => socket.say('{"op":'),
    (socket) => socket.say('null'),
    (socket) => socket.sayBytes(readGolden('mesh_grid.bin')), // unannounced
    ...[
      { vertices: 7 },
      { triangles: 5 },
      { colliders: [{ name: 'form', kind: 'mesh', vertices: 4, triangles: 4 }] },
    ].map((change) => (socket) => {
      socket.say({ ...GRID, ...change });
      socket.sayBytes(readGolden('mesh_grid.bin'));
    }),
    (socket) => {
      const ball = { name: 'ball', kind: 'sphere', center: [0, 0, 0], radius: 1 };
      socket.say({ ...GRID, vertices: 4, triangles: 2, colliders: Array(5).fill(ball) });
      socket.sayBytes(readGolden('mesh_colliders.bin'));
    },
    (socket) => {
      socket.say(GRID);
      socket.sayBytes(readGolden('mesh_grid.bin'));
      socket.sayBytes(readGolden('frame_one_vertex.bin'));
    },
  ];
  for (const say of speak) {
    const { client, socket, sockets, timers } = await join();
    const fault = client.next('fault');
    say(socket);
    assert.equal((await fault).name, 'ProtocolError');
    assert.equal(socket.closedWith.code, 4002);
    assert.equal(client.connected, false);
    await timers.pass(10000);
    assert.equal(sockets.length > 1, true);
  }
});

/** The announcement of a golden stream's mesh. */
const announced = ({ cloths, order, mesh }) => ({
  ...GRID,
  epoch: 3,
  cloths,
  vertices: order.vertices.length,
  triangles: decodeMesh(mesh).triangles.length / 3,
});

test('packed frames are told as float32 ones are, and acknowledged', async () => {
  for (const stream of packedStreams()) {
    const { client, socket } = await join();
    const told = [];
    client.on('frame', ({ positions }) => told.push(positions));
    socket.say(announced(stream));
    socket.sayBytes(stream.mesh);
    for (const [packed] of stream.frames) socket.sayBytes(packed);
    assert.equal(socket.acks.length, stream.frames.length);
    assert.deepEqual(told, stream.frames.map(([, plain]) => decodeFrame(plain).positions));
  }
});

test('packed frames before the mesh and without a key are acknowledged, and a key is asked for once', async () => {
  const [stream] = packedStreams();
  const { client, socket } = await join();
  const told = [];
  client.on('frame', ({ sequence }) => told.push(sequence));
  socket.sayBytes(stream.frames[0][0]);
  assert.deepEqual(socket.ops('view').map(({ codec }) => codec), ['packed']);
  socket.say(announced(stream));
  socket.sayBytes(stream.mesh);
  const rest = stream.frames.slice(3).map(([packed]) => packed);
  for (const packed of rest.slice(0, 4)) socket.sayBytes(packed);
  assert.equal(told.length, 0);
  assert.equal(socket.ops('view').length, 1);
  socket.sayBytes(stream.frames[0][0]);
  assert.equal(told.length, 1);
  assert.equal(socket.acks.length, 6);
});

test('a key that does not come is asked for again after a second, and on a new connection at once', async () => {
  const [stream] = packedStreams();
  const { socket, sockets, timers } = await join();
  const say = (to) => to.sayBytes(stream.frames[3][0]);
  const asked = (of) => of.ops('view').length;
  say(socket);
  await timers.pass(900);
  say(socket);
  assert.equal(asked(socket), 1);
  await timers.pass(200);
  say(socket);
  assert.equal(asked(socket), 2);
  socket.lose(1006);
  await timers.pass(300);
  sockets[1].open();
  sockets[1].say(welcome);
  say(sockets[1]);
  assert.equal(asked(sockets[1]), 1);
});

test('a frame that is decoded when its connection is lost is neither told nor acknowledged on the next', async () => {
  const waiting = [];
  const frames = { begin() {}, read: (bytes, done, fail) => waiting.push({ bytes, done, fail }) };
  const { client, socket, sockets, timers } = await join({ frames });
  const told = [];
  client.on('frame', ({ sequence }) => told.push(sequence));
  client.on('fault', (fault) => told.push(fault));
  const begin = (on) => {
    on.say(GRID);
    on.sayBytes(readGolden('mesh_grid.bin'));
    for (let k = 0; k < 2; k++) on.sayBytes(readGolden('frame_hands.bin'));
  };
  begin(socket);
  socket.lose(1006);
  await timers.pass(300);
  sockets[1].open();
  sockets[1].say(welcome);
  begin(sockets[1]);
  new FrameReader().read(waiting[0].bytes, waiting[0].done);
  waiting[1].fail(new ProtocolError('unreadable'));
  assert.equal(told.length, 0);
  assert.equal(sockets[1].acks.length, 0);
  assert.equal(sockets[1].closedWith, null);
  new FrameReader().read(waiting[2].bytes, waiting[2].done);
  assert.equal(told.length, 1);
  assert.equal(sockets[1].acks.length, 1);
});

test('frames may be decoded elsewhere, and what goes wrong there ends the connection', async () => {
  const waiting = [];
  const frames = { begin() {}, read: (bytes, done, fail) => waiting.push({ bytes, done, fail }) };
  const { client, socket } = await join({ frames });
  socket.say(GRID);
  socket.sayBytes(readGolden('mesh_grid.bin'));
  socket.sayBytes(readGolden('frame_hands.bin'));
  assert.equal(socket.acks.length, 0);
  const told = client.next('frame');
  new FrameReader().read(waiting[0].bytes, waiting[0].done);
  assert.equal((await told).positions.length, 18);
  assert.equal(socket.acks.length, 1);
  const fault = client.next('fault');
  waiting[0].fail(new ProtocolError('unreadable'));
  assert.equal((await fault).message, 'unreadable');
  assert.equal(socket.closedWith.code, 4002);
});

test('over HTTP the mesh is fetched from its address', async () => {
  const asked = [];
  const fetch = async (url) => {
    asked.push(url);
    return { ok: true, arrayBuffer: async () => readGolden('mesh_grid.bin').buffer };
  };
  const { client, socket } = await join({ mesh: 'http', fetch });
  assert.equal(socket.url, 'ws://host:1/ws?mesh=http');
  const mesh = client.next('mesh');
  socket.say(GRID);
  assert.equal((await mesh).data.restPositions.length, 18);
  assert.deepEqual(asked, ['http://host:1/api/v1/mesh/00']);
});

test('packed frames that come before a mesh over HTTP are passed over, and a key is asked for once it is there', async () => {
  const [first, second] = packedStreams();
  assert.notEqual(first.order.vertices.length, second.order.vertices.length);
  const fetched = [];
  const fetch = () => new Promise((resolve) => fetched.push(resolve));
  const deliver = ({ mesh }) => fetched.shift()({ ok: true, arrayBuffer: async () => mesh.slice().buffer });
  const { client, socket, sockets } = await join({ mesh: 'http', fetch });
  const told = [];
  client.on('frame', ({ sequence, positions }) => told.push([sequence, positions.length / 3]));
  client.on('fault', (fault) => assert.fail(fault));
  const meet = async (stream) => {
    const mesh = client.next('mesh');
    deliver(stream);
    await mesh;
  };
  socket.say(announced(first));
  await meet(first);
  socket.sayBytes(first.frames[3][0]); // without a key, which is so asked for just before the load
  assert.equal(socket.ops('view').length, 1);
  socket.say(announced(second));
  for (const [packed] of second.frames.slice(0, 3)) socket.sayBytes(packed);
  socket.sayBytes(readGolden('frame_observed.bin'));
  assert.equal(socket.acks.length, 4, 'all but the observed one are acknowledged');
  assert.equal(socket.ops('view').length, 1, 'a key would come too early');
  await meet(second);
  assert.deepEqual(socket.ops('view').map(({ codec }) => codec), ['packed', 'packed']);
  socket.sayBytes(second.frames[3][0]);
  assert.deepEqual(told, []);
  assert.equal(socket.ops('view').length, 2);
  socket.sayBytes(second.frames[0][0]);
  assert.deepEqual(told.map(([, vertices]) => vertices), [second.order.vertices.length]);
  assert.equal(sockets.length, 1);
});

test('a mesh over HTTP that no packed frame came before asks for no key', async () => {
  const [stream] = packedStreams();
  const fetch = async () => ({ ok: true, arrayBuffer: async () => stream.mesh.slice().buffer });
  const { client, socket } = await join({ mesh: 'http', fetch });
  const mesh = client.next('mesh');
  socket.say(announced(stream));
  await mesh;
  socket.sayBytes(stream.frames[0][0]);
  assert.equal(socket.ops('view').length, 0);
});

test('a binary query resolves when its data has come', async () => {
  const { client, socket } = await join();
  const query = client.query('positions', { format: 'f32' });
  answer(socket, 'query', { what: 'positions', binary: { transfer: 1, count: 5, components: 3 } });
  socket.sayBytes(readGolden('data_f32.bin'));
  const { values, components, tick } = await query;
  assert.equal(values.length, 15);
  assert.equal(components, 3);
  assert.equal(tick, 600);
});

test('what waits for an answer is told when the connection ends', async () => {
  const { client, socket } = await join();
  const calls = [client.hash(), client.query('positions', { format: 'f32' })];
  answer(socket, 'query', { binary: { transfer: 9 } });
  socket.lose(1006);
  for (const call of calls) await assert.rejects(call, ConnectionLost);
  await assert.rejects(client.pause(), ConnectionLost);
});

test('a call that is not answered in time rejects, and a late answer does no harm', async () => {
  const { client, socket, timers } = await join({ timeout: 700 });
  const settled = [];
  const watch = (name, promise) =>
    promise.then(
      () => settled.push(`${name} answered`),
      (error) => {
        assert.ok(error instanceof CallTimeout, `${error}`);
        settled.push(`${name} ${error.command} ${error.milliseconds}`);
      },
    );
  watch('own', client.hash({ timeout: 300 }));
  watch('client', client.pause());
  watch('longer', client.step(1, { timeout: 2000 }));
  watch('none', client.reset({ timeout: Infinity }));
  watch('advance', client.advance(10));
  watch('load', client.load('flag'));
  const ids = socket.sent.map(({ id }) => id);
  await timers.pass(299);
  assert.deepEqual(settled, []);
  await timers.pass(401);
  assert.deepEqual(settled, ['own hash 300', 'client pause 700']);
  socket.say({ op: 'result', id: ids[0], command: 'hash', hash: 'ff' });
  socket.say({ op: 'error', id: ids[1], code: 'internal', message: 'no' });
  const talk = async (seconds) => {
    // The server must not fall silent meanwhile.
    for (let i = 0; i < seconds; i++) {
      socket.say(example('state'));
      await timers.pass(1000);
    }
  };
  await talk(2);
  assert.deepEqual(settled.slice(2), ['longer step 2000']);
  await talk(68); // a minute, and a second for each tick
  assert.deepEqual(settled.slice(3), ['advance advance 70000']);
  await talk(240);
  assert.deepEqual(settled.slice(4), ['load load 300000']);
  answer(socket, 'reset');
  await timers.pass(1);
  assert.deepEqual(settled.slice(5), ['none answered']);
});

test('every command takes a time-out of its own as its last argument', async () => {
  const { client, timers } = await join();
  const calls = [];
  for (const { method, args, options } of readGoldenJson('client_calls.json')) {
    // Those that take options have them before it.
    const given = Object.keys(options).length ? [options] : [];
    const wanted = client[inCamels(method)].toString().match(/^(?:async )?\w+\(([^)]*(?:\([^)]*\))?[^)]*)\) \{/)[1];
    const names = wanted.replace(/\{[^}]*\}/g, '').split(',').map((part) => part.trim().split(' ')[0]);
    const list = [...args, ...given];
    while (list.length < names.indexOf('call')) list.push(undefined);
    assert.ok(names.includes('call'), method);
    calls.push(assert.rejects(client[inCamels(method)](...list, { timeout: 5 }), CallTimeout, method));
  }
  await timers.pass(5000);
  await Promise.all(calls);
});

test('messages are sent in their order and never faster than the limit that welcome tells', async () => {
  for (const limit of [1, 3, 50, 1000]) {
    const limits = { ...welcome.limits, messages_per_second: limit };
    const { FakeSocket, sockets } = fakeSockets();
    const timers = new FakeTimers();
    const client = new WeftClient('ws://host:1/ws', { WebSocket: FakeSocket, timers, name: 'Ada' });
    const connected = client.connect();
    const times = [];
    FakeSocket.prototype.send = function (data) {
      this.sent.push(JSON.parse(data));
      times.push(timers.time);
    };
    sockets[0].open();
    sockets[0].say({ ...welcome, limits });
    await connected;
    const count = 3 * limit + 5;
    for (let number = 0; number < count; number++) client.post('camera', { number });
    for (let ms = 0; ms < 20000; ms += 500) {
      sockets[0].say(example('state'));
      await timers.pass(500);
    }
    const numbers = sockets[0].ops('camera').map(({ number }) => number);
    assert.deepEqual(numbers, [...Array(count).keys()], `${limit}`);
    // The server's bucket: as many at once as in a second.
    let tokens = limit;
    let last = 0;
    for (const time of times) {
      tokens = Math.min(limit, tokens + ((time - last) * limit) / 1000);
      last = time;
      assert.ok(tokens >= 1, `${limit}: message at ${time} ms`);
      tokens -= 1;
    }
    const [first, end] = [times[0], times[count - 1]];
    assert.ok(end - first <= (1000 * count) / (0.9 * limit) + 3000 / limit, `${limit}`);
    client.close();
  }
});

test('what waits for its turn when the connection is lost is not sent on the next', async () => {
  const { client, sockets, timers } = await join();
  for (let i = 0; i < 2000; ++i) client.post('camera', { i });
  const last = client.hash();
  assert.equal(sockets[0].ops('hash').length, 0);
  sockets[0].lose(1006);
  await assert.rejects(last, ConnectionLost);
  await timers.pass(300);
  sockets[1].open();
  sockets[1].say(welcome);
  await timers.pass(5000);
  assert.deepEqual(new Set(sockets[1].sent.map(({ op }) => op)), new Set(['ping']));
});

test('a ping is stamped when it leaves, not when it waits for its turn', async () => {
  const { client, socket, timers } = await join();
  while (socket.ops('ping').length) socket.sent.pop();
  for (let i = 0; i < 1000; ++i) client.post('camera', {});
  const measured = client.ping();
  await timers.pass(2000);
  const { id, t } = socket.ops('ping')[0];
  const clock = timers.time / 1000;
  assert.ok(t > 0.5, `${t}`);
  socket.say({ op: 'result', id, command: 'ping', t, received: clock, sent: clock });
  await measured;
  assert.ok(client.roundTrip < 2 - 0.5);
});

test('it reconnects with growing pauses, and soon again after a welcome', async () => {
  const { client, sockets, timers } = await join({ name: 'Ada' });
  const pauses = [];
  client.on('status', ({ phase, retryIn }) => phase === 'waiting' && pauses.push(retryIn));
  sockets[0].lose(1006);
  for (let i = 1; i <= 7; ++i) {
    await timers.pass(pauses.at(-1) - 1);
    assert.equal(sockets.length, i);
    await timers.pass(1);
    assert.equal(sockets.length, i + 1);
    if (i < 7) sockets[i].lose(1006);
  }
  assert.deepEqual(pauses, [250, 500, 1000, 2000, 4000, 8000, 8000]);
  sockets[7].open();
  sockets[7].say(welcome);
  assert.deepEqual(sockets[7].ops('hello'), [{ op: 'hello', name: 'Ada' }]);
  sockets[7].lose(1012);
  assert.equal(pauses.at(-1), 250);
});

test('it does not come back after codes that would only repeat', async () => {
  for (const code of [1002, 1003, 1007, 1008, 1009, 4003]) {
    const { client, sockets, timers } = await join();
    const closed = client.next('status');
    sockets[0].lose(code, 'no');
    assert.equal((await closed).phase, 'closed');
    await timers.pass(60000);
    assert.equal(sockets.length, 1);
  }
});

test('close ends for good, and connect rejects when it may not try again', async () => {
  const { client, socket, sockets, timers } = await join();
  client.close();
  assert.equal(socket.closedWith.code, 1000);
  await timers.pass(60000);
  assert.equal(sockets.length, 1);

  const { FakeSocket, sockets: others } = fakeSockets();
  const once = new WeftClient('ws://host:1/ws', {
    WebSocket: FakeSocket, timers: new FakeTimers(), reconnect: false,
  });
  const connected = once.connect();
  others[0].lose(1006);
  await assert.rejects(connected, ConnectionLost);
});

test('connect is given up in time where there is no such room or no server, and goes on trying', async () => {
  const { FakeSocket, sockets } = fakeSockets();
  const timers = new FakeTimers();
  const client = new WeftClient('ws://host:1/ws/nope', { WebSocket: FakeSocket, timers, timeout: 2000 });
  const refused = assert.rejects(client.connect(), CallTimeout);
  sockets[0].lose(1006);
  await timers.pass(2001);
  await refused;
  await timers.pass(10000);
  sockets.at(-1).open();
  sockets.at(-1).say(welcome);
  assert.equal(client.connected, true);
  client.close();
});

test('connect that is not to try again fails at once, also where no close event follows the error', async () => {
  for (const fail of [(socket) => socket.lose(1006), (socket) => socket.onerror({})]) {
    const { FakeSocket, sockets } = fakeSockets();
    const timers = new FakeTimers();
    const client = new WeftClient('ws://host:1/ws/nope', { WebSocket: FakeSocket, timers, reconnect: false });
    const refused = assert.rejects(client.connect(), ConnectionLost);
    fail(sockets[0]);
    await timers.pass(100);
    await refused;
    await timers.pass(100000);
    assert.equal(sockets.length, 1);
  }
});

test('an error before the handshake is tried again soon, one of a socket that was left counts for nothing', async () => {
  const { FakeSocket, sockets } = fakeSockets();
  const timers = new FakeTimers();
  const client = new WeftClient('ws://host:1/ws', { WebSocket: FakeSocket, timers });
  const connected = client.connect();
  sockets[0].onerror({});
  sockets[0].onerror({});
  await timers.pass(500);
  assert.equal(sockets.length, 2);
  sockets[0].onerror({});
  await timers.pass(500);
  assert.equal(sockets.length, 2);
  sockets[1].open();
  sockets[1].say(welcome);
  sockets[1].onerror({});
  await timers.pass(500);
  await connected;
  assert.equal(client.connected, true);
  client.close();
});

test('a number that is not finite is refused by its name, whatever sends it, and nothing is sent', async () => {
  const { client, socket } = await join();
  const sent = socket.sent.length;
  await assert.rejects(client.set({ drag: NaN }), { name: 'RangeError', message: /set\.drag = NaN/ });
  await assert.rejects(client.load({ cloths: [{ width: Infinity }] }), /cloths\[0\]\.width = Infinity/);
  assert.throws(() => client.post('move', { target: [0, -Infinity, 0] }), /move\.target\[1\]/);
  assert.equal(socket.sent.length, sent);
});

test('nothing is sent on a socket that the server closes, of which a browser would complain', async () => {
  const { client, socket } = await join();
  socket.readyState = 1;
  client.post('camera', {});
  assert.equal(socket.ops('camera').length, 1);
  socket.readyState = 2;
  client.post('camera', {});
  assert.equal(socket.ops('camera').length, 1);
  socket.lose(4004, 'the room is closed');
});

test('a client that moves to another room leaves the first, and has its name, token and view there', async () => {
  const { client, socket, sockets } = await join({ name: 'Ada', token: 'of a link' });
  const viewed = client.view({ hz: 30 });
  answer(socket, 'view');
  await viewed;
  const phases = [];
  client.on('status', ({ phase }) => phases.push(phase));
  const asked = client.pause();
  client.enter('ws://host:1/ws/mine');
  await assert.rejects(asked, ConnectionLost);
  assert.equal(socket.closedWith.code, 1000);
  assert.deepEqual(phases, ['closed', 'connecting']);
  assert.equal(client.connected, false);
  const there = sockets.at(-1);
  assert.equal(there.url, 'ws://host:1/ws/mine');
  there.open();
  there.say({ ...welcome, room: 'mine' });
  assert.equal(client.welcome.room, 'mine');
  assert.equal(there.ops('hello')[0].name, 'Ada');
  assert.equal(there.ops('hello')[0].token, 'of a link');
  assert.equal(there.ops('view')[0].hz, 30);
  client.enter('ws://host:1/ws/copy', 'of the copy');
  sockets.at(-1).open();
  assert.equal(sockets.at(-1).ops('hello')[0].token, 'of the copy');
  sockets.at(-1).say(welcome);
  socket.say({ ...example('state') });
  socket.lose(1006);
  assert.equal(client.connected, true, 'what the first room says is not heard any more');
});

test('a link brings its token, and one that is given goes before it', async () => {
  const { FakeSocket, sockets } = fakeSockets();
  const options = { WebSocket: FakeSocket, timers: new FakeTimers() };
  for (const [given, said] of [[undefined, 'of the link'], ['of its own', 'of its own']]) {
    const client = new WeftClient('http://host:1/#token=of%20the%20link', { ...options, token: given });
    client.connect().catch(() => {}); // it is closed before it is welcome
    const socket = sockets.at(-1);
    socket.open();
    assert.equal(socket.url, 'ws://host:1/ws');
    assert.equal(socket.ops('hello')[0].token, said);
    client.enter('http://host:1/#token=another');
    sockets.at(-1).open();
    assert.equal(sockets.at(-1).ops('hello')[0].token, 'another');
    client.close();
  }
});

test('a client that was closed for good moves to a room that there is', async () => {
  const { client, socket, sockets } = await join({ mesh: 'http' });
  socket.lose(4004, 'the room is closed');
  client.enter('ws://host:1/ws/other');
  assert.equal(sockets.at(-1).url, 'ws://host:1/ws/other?mesh=http');
});

test('a server that falls silent is given up, one that speaks is not', async () => {
  const { client, sockets, timers } = await join();
  for (let i = 0; i < 10; ++i) {
    await timers.pass(3000);
    sockets[0].say(example('state'));
  }
  assert.equal(client.connected, true);
  await timers.pass(13000);
  assert.equal(sockets[0].closedWith.reason, 'the server is silent');
});

test('a handshake that does not end is given up', async () => {
  const { FakeSocket, sockets } = fakeSockets();
  const timers = new FakeTimers();
  const client = new WeftClient('ws://host:1/ws', { WebSocket: FakeSocket, timers });
  client.connect().catch(() => {});
  await timers.pass(9999);
  assert.equal(sockets.length, 1);
  await timers.pass(1000);
  assert.equal(sockets.length, 2);
  client.close();
});

test('an open event and messages that wait behind a long task are seen before time is up', async () => {
  const { FakeSocket, sockets } = fakeSockets();
  const timers = new FakeTimers();
  const client = new WeftClient('ws://host:1/ws', { WebSocket: FakeSocket, timers });
  client.connect().catch(() => {});
  timers.time += 15_000; // a task of this length; the timer is the first event after it
  await timers.pass(0);
  sockets[0].open();
  sockets[0].say(welcome);
  await timers.pass(100);
  assert.equal(client.connected, true);
  timers.time += 15_000;
  await timers.pass(0);
  sockets[0].say(example('state'));
  await timers.pass(100);
  assert.equal(client.connected, true);
  assert.equal(sockets.length, 1);
  client.close();
});

test('a drag starts at the hit, moves, repeats its target and ends', async () => {
  const { client, socket, timers } = await join();
  const drag = client.drag(HIT, { radius: 0.05, target: [0, 1, 0] });
  const { id, ...start } = socket.ops('drag')[0];
  assert.deepEqual(start, {
    op: 'drag', phase: 'start', drag: 1, triangle: 411, barycentric: [0.25, 0.5, 0.25],
    radius: 0.05, target: [0, 1, 0],
  });
  answer(socket, 'drag', { drag: 1, grab: 17, target: [0, 1, 0] });
  assert.equal((await drag.started).grab, 17);
  await timers.pass(20);
  drag.move([0, 2, 0]);
  const move = (target) => ({ op: 'drag', phase: 'move', drag: 1, target });
  assert.deepEqual(socket.sent.at(-1), move([0, 2, 0]));
  const before = socket.ops('drag').length;
  await timers.pass(2000); // no more than 0.5 s apart
  const repeated = socket.ops('drag').slice(before);
  assert.equal(repeated.length, 5);
  for (const message of repeated) assert.deepEqual(message, move([0, 2, 0]));
  drag.end();
  assert.deepEqual(socket.sent.at(-1), { op: 'drag', phase: 'end', drag: 1 });
  assert.equal(await drag.ended, 'end');
  const after = socket.ops('drag').length;
  drag.move([9, 9, 9]);
  await timers.pass(2000);
  assert.equal(socket.ops('drag').length, after);
});

test('without a target of its own a drag repeats the one that the server chose', async () => {
  const { client, socket, timers } = await join();
  client.drag({ particle: 3 });
  answer(socket, 'drag', { drag: 1, grab: 17, target: [1, 2, 3] });
  await timers.pass(450);
  assert.deepEqual(socket.ops('drag').at(-1), {
    op: 'drag', phase: 'move', drag: 1, target: [1, 2, 3],
  });
});

test('targets that come too quickly are thinned out, and the last one is sent', async () => {
  const { client, socket, timers } = await join();
  const drag = client.drag(HIT, { target: [0, 0, 0] });
  for (let i = 1; i <= 1000; ++i) {
    drag.move([i, 0, 0]);
    await timers.pass(0.1); // 10,000 a second, for 100 ms
  }
  const moves = socket.ops('drag').filter(({ phase }) => phase === 'move');
  assert.ok(moves.length >= 11 && moves.length <= 13, `${moves.length}`);
  await timers.pass(8);
  assert.equal(socket.ops('drag').at(-1).target[0], 1000);
  drag.move([2000, 0, 0]);
  drag.end(); // what waits goes first
  assert.deepEqual(socket.ops('drag').slice(-2).map(({ target, phase }) => target?.[0] ?? phase),
    [2000, 'end']);
});

test('several hands have numbers of their own', async () => {
  const { client, socket } = await join();
  const numbers = [client.drag(HIT), client.drag({ particle: 7 })].map(({ number }) => number);
  assert.equal(new Set(numbers).size, 2);
  assert.deepEqual(socket.ops('drag').map(({ drag }) => drag), numbers);
});

test('a drag ends with the connection, the lease, the server, or a refusal', async () => {
  const begin = async () => {
    const joined = await join();
    const drag = joined.client.drag(HIT);
    answer(joined.socket, 'drag', { drag: drag.number, grab: 17, target: [0, 0, 0] });
    await drag.started;
    return { ...joined, drag };
  };
  const lost = await begin();
  lost.socket.lose(1006);
  assert.equal(await lost.drag.ended, 'connection lost');

  const expired = await begin();
  const { number: value } = expired.drag;
  expired.socket.say({ op: 'error', code: 'unknown_drag', message: '', field: 'drag', value });
  assert.equal(await expired.drag.ended, 'lease expired');

  const released = await begin();
  const grab = { ...example('grabs').grabs[0], id: 17 };
  released.socket.say({ op: 'grabs', tick: 1, grabs: [grab] });
  assert.equal(released.drag.active, true);
  released.socket.say({ op: 'grabs', tick: 2, grabs: [] });
  assert.equal(await released.drag.ended, 'released by the server');

  const { client, socket } = await join();
  const refused = client.drag(HIT);
  socket.say({ op: 'error', id: socket.ops('drag')[0].id, code: 'held', message: 'held by Bob' });
  assert.equal(await refused.ended, 'held by Bob');
  await assert.rejects(refused.started, CommandError);
});

test('what the server has accepted of a view and a name is said again after a reconnection, nothing else', async () => {
  const { client, socket, sockets, timers } = await join();
  const refuse = (op, field) => {
    const { id } = socket.ops(op).at(-1);
    socket.say({ op: 'error', id, command: op, code: 'out_of_range', message: 'no', field });
  };
  const accepted = [client.view({ hz: 20, codec: 'packed' }), client.hello({ name: 'Ada' })];
  answer(socket, 'view');
  answer(socket, 'hello');
  await Promise.all(accepted);
  const refused = [client.view({ hz: 300 }), client.hello({ name: 'x'.repeat(40), color: '#123456' })];
  refuse('view', 'hz');
  refuse('hello', 'name');
  for (const call of refused) await assert.rejects(call, CommandError);
  client.view({ hz: 0 }).catch(() => {}); // lost with its connection
  sockets[0].lose(1006);
  await timers.pass(300);
  sockets[1].open();
  assert.deepEqual(sockets[1].ops('view'), [{ op: 'view', hz: 20, codec: 'packed' }]);
  assert.deepEqual(sockets[1].ops('hello'), [{ op: 'hello', name: 'Ada' }]);
});

test('clock and round trip come from the ping with the least delay', async () => {
  const { client, socket, timers } = await join();
  // The server's clock is 100 s ahead; the way there takes twice the way back in slow pings.
  const ping = async (there, back) => {
    const measured = client.ping();
    const { id, t } = socket.ops('ping').at(-1);
    await timers.pass(there * 1000);
    const received = timers.time / 1000 + 100;
    await timers.pass(2);
    const sent = timers.time / 1000 + 100;
    await timers.pass(back * 1000);
    socket.say({ op: 'result', id, command: 'ping', t, received, sent });
    await measured;
  };
  await ping(0.05, 0.05);
  await ping(0.2, 0.1);
  assert.ok(Math.abs(client.roundTrip - 0.1) < 1e-9);
  assert.ok(Math.abs(client.serverTime - timers.time / 1000 - 100) < 1e-9);
});

test('latency is from the sending of a command to the frame that includes it', async () => {
  const { client, socket, timers } = await join();
  // The golden frame says that message 41 of viewer 3 is included.
  while (socket.sent.length < 40) client.post('camera', {});
  assert.ok(Number.isNaN(client.latency));
  client.post('drag', { phase: 'move', drag: 1, target: [0, 0, 0] });
  assert.equal(socket.sent.length, 41);
  timers.time += 25;
  client.post('drag', { phase: 'move', drag: 1, target: [1, 0, 0] }); // number 42
  timers.time += 10;
  socket.sayBytes(readGolden('frame_hands.bin'));
  assert.ok(Math.abs(client.latency - 0.035) < 1e-9);
});

test('messages are counted anew on each connection', async () => {
  const { client, sockets, timers } = await join();
  while (sockets[0].sent.length < 50) client.post('camera', {});
  sockets[0].lose(1006);
  await timers.pass(300);
  sockets[1].open();
  sockets[1].say(welcome);
  while (sockets[1].sent.length < 40) client.post('camera', {});
  client.post('drag', { phase: 'move', drag: 1, target: [0, 0, 0] });
  timers.time += 30;
  sockets[1].sayBytes(readGolden('frame_hands.bin'));
  assert.ok(Math.abs(client.latency - 0.03) < 1e-9);
});

test('an exception of a listener is not taken for a fault of the server', async () => {
  const { client, socket } = await join();
  client.on('state', () => {
    throw new TypeError('mine');
  });
  assert.throws(() => socket.say(example('state')), TypeError);
  assert.equal(client.connected, true);
  await settle();
});

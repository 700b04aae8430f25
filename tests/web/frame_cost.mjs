// Prints what a frame costs the page's script: CPU time from the bytes of the wire to buffers that
// are ready to draw, without drawing. With WEFT_PROGRAM it also measures packed frames of a server's
// cloth in gusts that a hand holds, whose decoding the page leaves to a worker.
// usage: [WEFT_PROGRAM=build/weft] node tests/web/frame_cost.mjs [FRAMES]
import { FrameReader } from '../../proto/js/index.js';
import { decodeFrame } from '../../proto/js/codec.js';
import { import_page_module } from './support/page_module.mjs';

const { WorldView } = await import_page_module('view/world_view');
const { OrbitCamera } = await import_page_module('view/camera');
const { cast_ray, point_on_triangle } = await import_page_module('view/ray');

const frames = Number(process.argv[2] ?? 600);
const TICK = 1 / 60; // [s]
const GRAB_BYTES = 36;
const WARM_UP = 60; // frames
const RECORDED = 60; // frames
const SHOWN_ERROR = 4e-4; // that the page allows [m]
const studio = { scene: { add() {} }, set_floor() {}, raise_floor() {}, light() {} };

/** The binary message of a frame with one hand. */
function frame_message(tick, positions) {
  const bytes = new ArrayBuffer(64 + 8 + positions.byteLength + (positions.byteLength % 8) + 8 + 40);
  const view = new DataView(bytes);
  view.setUint8(0, 1);
  view.setUint8(1, 1);
  view.setUint8(3, 1);
  view.setUint32(4, bytes.byteLength, true);
  view.setUint32(16, tick, true);
  view.setFloat64(24, tick * TICK, true);
  view.setFloat64(32, 100 + tick * TICK, true);
  view.setUint32(40, tick, true);
  view.setUint32(44, tick, true);
  view.setUint32(52, positions.length / 3, true);
  view.setUint32(60, 2, true);
  view.setUint16(64, 1, true);
  view.setUint32(68, positions.byteLength, true);
  new Float32Array(bytes, 72, positions.length).set(positions);
  const grabs = 72 + Math.ceil(positions.byteLength / 8) * 8;
  view.setUint16(grabs, 2, true);
  view.setUint32(grabs + 4, GRAB_BYTES, true);
  view.setUint32(grabs + 8, 1, true);
  view.setUint32(grabs + 12, 1, true);
  const words = new Uint32Array(bytes);
  let [a, b] = [0, 0];
  for (const [k, word] of words.entries()) {
    a = (a + word) >>> 0;
    b = (b + Math.imul(k + 1, word)) >>> 0;
  }
  view.setUint32(8, a, true);
  view.setUint32(12, b, true);
  return bytes;
}

const is_packed = (bytes) => new Uint8Array(bytes)[2] === 2;

/** A waving square metre of n by n particles. */
function cloth_at(n, time) {
  const positions = new Float32Array(n * n * 3);
  for (let k = 0; k < n * n; k++) {
    const [u, v] = [(k % n) / (n - 1), Math.floor(k / n) / (n - 1)];
    positions.set([u, 1.5 - v, 0.05 * Math.sin(9 * u + 5 * v + 4 * time)], k * 3);
  }
  return positions;
}

function world_of(n, fabric) {
  const triangles = new Uint32Array((n - 1) ** 2 * 6);
  const uv = Float32Array.from({ length: n * n * 2 }, (_, k) =>
    k % 2 ? Math.floor(k / 2 / n) / (n - 1) : ((k / 2) % n) / (n - 1));
  for (let row = 0, to = 0; row < n - 1; row++) {
    for (let column = 0; column < n - 1; column++, to += 6) {
      const [a, b, c, d] = [0, 1, n, n + 1].map((next) => row * n + column + next);
      triangles.set((row + column) % 2 ? [a, b, c, b, d, c] : [a, b, d, a, d, c], to);
    }
  }
  const size = { vertices: n * n, triangles: triangles.length / 3 };
  const cloth = { name: 'cloth', first_vertex: 0, first_triangle: 0, rows: n, columns: n, ...size };
  const cloths = [{ ...cloth, thickness: 0.004, look: { fabric } }];
  const announcement = { cloths, colliders: [], scene: 'made-up', ...size };
  const data = { restPositions: cloth_at(n, 0), triangles, uv, colliders: [] };
  return new WorldView(announcement, data, studio);
}

/**
 * Milliseconds of CPU time of an act, the mean of many. The system counts CPU time in steps longer
 * than one act, so all acts are timed together.
 */
function mean_cost(act) {
  for (let k = 0; k < WARM_UP; k++) act(k); // until it is compiled
  const before = process.cpuUsage();
  for (let k = 0; k < frames; k++) act(WARM_UP + k);
  const { user, system } = process.cpuUsage(before);
  return (user + system) / 1000 / frames;
}

/** Milliseconds of CPU time a frame, by part. @param decode decodes the k-th frame */
function cost_of(world, decode, decoded) {
  const { camera } = new OrbitCamera();
  camera.updateMatrixWorld();
  const show = (k) => {
    const frame = { ...decoded[k % decoded.length], tick: k, serverTime: 100 + k * TICK };
    world.push(frame, k * TICK);
    world.show(k * TICK, true);
    point_on_triangle(0, [1, 0, 0], world.playback.positions, world.triangles);
  };
  const cost = {
    decode: mean_cost(decode),
    show: mean_cost(show),
    order: mean_cost(() => world.look_from(camera)),
    ray: mean_cost(() =>
      cast_ray([0.4, 1, 3], [0, 0, -1], world.playback.positions, world.triangles)),
  };
  world.dispose();
  return cost;
}

function made_up_cost(n, fabric) {
  const messages = Array.from({ length: 20 }, (_, k) => frame_message(k, cloth_at(n, k * TICK)));
  const decode = (k) => decodeFrame(messages[k % messages.length]);
  return cost_of(world_of(n, fabric), decode, messages.map((message) => decodeFrame(message)));
}

/** Packed frames of a server's cloth in gusts, one for each tick, as bytes and as they are read. */
async function record(n, fabric) {
  const { start_server } = await import('./support/server.mjs');
  // Its motion counts alone, so that nothing is spent on contact with itself.
  const settings = [`cloth.rows=${n}`, `cloth.columns=${n}`, `fabric=${fabric}`, 'environment.wind=1,0,4',
    'contact.self=none'];
  const server = await start_server(['--paused', '--scene', 'wall', ...settings.flatMap((each) => ['--set', each])]);
  const record = { frames: [] };
  const reader = new FrameReader();
  const frames = {
    begin: (...mesh) => reader.begin(...(record.mesh = mesh)),
    read(bytes, done) {
      const received = reader.take(bytes);
      record.frames.push({ bytes, frame: received.frame });
      done(received);
    },
  };
  const script = await server.script('script', { frames });
  await script.view({ codec: 'packed', error: SHOWN_ERROR });
  await script.drag({ particle: Math.floor((n * n) / 2) }, { target: [0, 1, 0.5] }).started;
  await script.advance(RECORDED, { frames: 'all' });
  record.announcement = script.mesh.announcement;
  script.close();
  await server.stop();
  record.frames = record.frames.filter(({ bytes }) => is_packed(bytes));
  return record;
}

async function packed_cost(n, fabric) {
  const { mesh, frames, announcement } = await record(n, fabric);
  const [cloths, data] = mesh;
  let reader;
  const decode = (k) => {
    if (k % frames.length === 0) {
      reader = new FrameReader(); // the first is a key
      reader.begin(cloths, data);
    }
    reader.take(frames[k % frames.length].bytes);
  };
  const world = new WorldView({ ...announcement, cloths, colliders: [] }, { ...data, colliders: [] }, studio);
  return cost_of(world, decode, frames.map(({ frame }) => frame));
}

function print(name, cost) {
  const sum = Object.values(cost).reduce((total, part) => total + part, 0);
  const figures = [cost.decode, cost.show, cost.order, cost.ray, sum];
  const text = figures.map((value) => value.toFixed(2).padStart(8)).join('');
  console.log(`${name.padEnd(26)}${text}`);
}

const heads = ['decode', 'show', 'order', 'ray', 'sum'];
console.log(`CPU time of ${frames} frames, milliseconds each: decoding; playback, subdivision, normals`);
console.log('and hems; order of see-through triangles; the ray of a hovering pointer');
console.log(['cloth'.padEnd(26), ...heads.map((head) => head.padStart(8))].join(''));
for (const fabric of ['cotton', 'silk']) {
  for (const n of [32, 64, 128]) print(`${n} x ${n} ${fabric}`, made_up_cost(n, fabric));
  if (process.env.WEFT_PROGRAM) print(`128 x 128 ${fabric}, packed`, await packed_cost(128, fabric));
}

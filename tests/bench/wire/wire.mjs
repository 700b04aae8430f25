// The second half of measure.sh: decodes the streams that weft_wire_bench has left, in
// JavaScript, and packs the same whole numbers as differences to the last frame with meshoptimizer.
// Usage: wire.mjs FOLDER [MESHOPTIMIZER, its module]

import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

import { FrameDecoder, decodeMesh, orderOf } from '../../../proto/js/index.js';

const [folder, module] = process.argv.slice(2);
const LEVEL = 2; // meshoptimizer's default
const KEY = 1;

/** The smaller one of what the encoder makes of 16-bit and of 32-bit differences. */
class Meshoptimizer {
  constructor(encoder, version) {
    this.encoder = encoder;
    this.version = version;
  }

  static async load(path) {
    if (!path) return null;
    const { MeshoptEncoder } = await import(pathToFileURL(path));
    await MeshoptEncoder.ready;
    const { version } = JSON.parse(readFileSync(join(path, '../package.json'), 'utf8'));
    return new Meshoptimizer(MeshoptEncoder, version);
  }

  size(differences, count) {
    const narrow = new Int16Array(4 * count);
    const wide = new Int32Array(3 * count);
    let fits = true;
    for (let i = 0; i < count; ++i)
      for (let c = 0; c < 3; ++c) {
        const d = differences[c * (count + 1) + i];
        wide[3 * i + c] = (d << 1) ^ (d >> 31);
        narrow[4 * i + c] = wide[3 * i + c];
        fits &&= wide[3 * i + c] < 65536;
      }
    const encode = (array, stride) =>
      this.encoder.encodeVertexBufferLevel(new Uint8Array(array.buffer), count, stride, LEVEL, 1);
    const sizes = [encode(wide, 12).length];
    if (fits) sizes.push(encode(narrow, 8).length);
    return Math.min(...sizes);
  }
}

/** CPU time of this process, so that other programs do not count. */
function cpuMilliseconds() {
  const { user, system } = process.cpuUsage();
  return (user + system) / 1e3;
}

const median = (values) => values.sort((a, b) => a - b)[values.length >> 1];

function messagesOf(path) {
  const messages = [];
  for (let rest = new Uint8Array(readFileSync(path)); rest.length; ) {
    const length = new DataView(rest.buffer, rest.byteOffset).getUint32(4, true);
    messages.push(rest.slice(0, length));
    rest = rest.subarray(length);
  }
  return messages;
}

function measure(row, meshoptimizer) {
  const [mesh, ...frames] = messagesOf(join(folder, row.stream));
  const { rows, columns, vertices } = row;
  const order = orderOf([{ first_vertex: 0, vertices, rows, columns }], decodeMesh(mesh));
  // Twice: the compressor must not push the decoder's tables out of the caches.
  const times = [];
  const timed = new FrameDecoder(order);
  for (const frame of frames) {
    const start = cpuMilliseconds();
    timed.decode(frame);
    times.push(cpuMilliseconds() - start);
  }
  const sizes = [];
  let last = null; // the numbers before; those on another lattice are none
  const differences = new Int32Array(3 * (vertices + 1));
  const decoder = new FrameDecoder(order);
  for (const frame of meshoptimizer ? frames : []) {
    const { flags } = decoder.decode(frame);
    const { numbers } = decoder;
    if (last && !(flags & KEY)) {
      for (let i = 0; i < numbers.length; ++i) differences[i] = numbers[i] - last[i];
      sizes.push(meshoptimizer.size(differences, vertices) / vertices);
    }
    last = numbers.slice();
  }
  const mean = sizes.reduce((sum, size) => sum + size, 0) / sizes.length;
  return { script: median(times), general: mean };
}

const meshoptimizer = await Meshoptimizer.load(module);
const general = meshoptimizer ? `differences + meshoptimizer ${meshoptimizer.version}` : 'none';
console.log(`B a vertex and frame, headers included; general compressor: ${general}`);
console.log('motion mesh   m/s    bound   error  float32 int16 (error) general packed (p95)  ratio | ms encode decode JS');
for (const row of JSON.parse(readFileSync(join(folder, 'wire.json'), 'utf8'))) {
  const { script, general: other } = measure(row, meshoptimizer);
  const millimetres = (metres) => (1e3 * metres).toFixed(4);
  console.log(
    [
      row.motion.padEnd(6),
      row.mesh.padEnd(6),
      row.mean_speed.toFixed(4),
      `${1e3 * row.error_bound} mm`.padEnd(7),
      millimetres(row.largest_error),
      row.float32_bytes.toFixed(2),
      `${row.int16_bytes.toFixed(2)} (${millimetres(row.int16_largest_error)})`,
      Number.isNaN(other) ? '-' : other.toFixed(3),
      `${row.packed_bytes.toFixed(3)} (${row.packed_bytes_p95.toFixed(3)})`,
      Number.isNaN(other) ? '-' : (row.packed_bytes / other).toFixed(3),
      '|',
      row.encode_ms.toFixed(3),
      row.decode_ms.toFixed(3),
      script.toFixed(3),
    ].join(' '),
  );
}

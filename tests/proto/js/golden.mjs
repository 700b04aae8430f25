import { decodeMesh, orderOf } from '../../../proto/js/index.js';
import { readFileSync } from 'node:fs';

const root = new URL('../../../', import.meta.url);

export const readGolden = (name) =>
  new Uint8Array(readFileSync(new URL(`tests/proto/golden/${name}`, root)));

export const readGoldenJson = (name) =>
  JSON.parse(readFileSync(new URL(`tests/proto/golden/${name}`, root), 'utf8'));

/** The JSON examples of the specification. */
export function specificationExamples() {
  const page = readFileSync(new URL('proto/README.md', root), 'utf8');
  return [...page.matchAll(/^```json\n(.*?)^```$/gms)].map(([, text]) => JSON.parse(text));
}

/** Golden binary messages: name, what must be read, bytes. */
export function binaryGoldens() {
  return Object.entries(readGoldenJson('binary.json')).map(([name, content]) => ({
    name,
    content,
    bytes: readGolden(`${name}.bin`),
  }));
}

/** Length and checksum put right again after a change, so that a decoder looks further. */
export function sealed(bytes) {
  if (bytes.length < 16) return bytes;
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  view.setUint32(4, bytes.length, true);
  view.setBigUint64(8, 0n, true);
  let a = 0n;
  let b = 0n;
  for (let j = 0; j < Math.floor(bytes.length / 4); ++j) {
    const word = BigInt(view.getUint32(4 * j, true));
    a += word;
    b += BigInt(j + 1) * word;
  }
  view.setUint32(8, Number(BigInt.asUintN(32, a)), true);
  view.setUint32(12, Number(BigInt.asUintN(32, b)), true);
  return bytes;
}

/** Golden streams of the codec `packed`: a mesh, and frames as pairs (packed, plain). */
export function packedStreams() {
  const streams = [];
  for (const [name, { cloths }] of Object.entries(readGoldenJson('packed.json'))) {
    if (name === 'refused') continue;
    const messages = [];
    for (let rest = readGolden(`${name}.bin`); rest.length; ) {
      const length = new DataView(rest.buffer, rest.byteOffset).getUint32(4, true);
      messages.push(rest.slice(0, length));
      rest = rest.subarray(length);
    }
    const [mesh, ...halves] = messages;
    const frames = [];
    for (let i = 0; i < halves.length; i += 2) frames.push([halves[i], halves[i + 1]]);
    streams.push({ name, cloths, mesh, order: orderOf(cloths, decodeMesh(mesh)), frames });
  }
  return streams;
}

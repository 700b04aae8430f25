import assert from 'node:assert/strict';
import test from 'node:test';

import {
  ProtocolError,
  decodeBinary,
  decodeData,
  decodeFrame,
  decodeMesh,
  encodeAck,
} from '../../../proto/js/index.js';
import { binaryGoldens, readGolden, readGoldenJson, sealed } from './golden.mjs';

const decoders = { frame: decodeFrame, mesh: decodeMesh, data: decodeData };

/** Bit patterns, so that -0 and 0 differ. */
const bits = (values) => [...new Uint32Array(values.slice().buffer)];
const sameFloats = (values, expected) =>
  assert.deepEqual(bits(values), bits(Float32Array.from(expected)));

/** Whether the bytes are accepted; any other error than ProtocolError fails the test. */
function accepts(type, bytes) {
  try {
    decoders[type](bytes);
    return true;
  } catch (error) {
    if (!(error instanceof ProtocolError)) throw error;
    return false;
  }
}

test('golden frames are read bit for bit', () => {
  for (const { content, bytes } of binaryGoldens().filter(({ content }) => content.type === 'frame')) {
    const frame = decodeFrame(bytes);
    const { flags, tick, time, server_time: serverTime, sequence, reference, epoch } = content.header;
    const expected = { flags, tick, time, serverTime, sequence, reference, epoch };
    for (const [name, value] of Object.entries(expected)) assert.equal(frame[name], value, name);
    assert.equal(frame.jump, (flags & 2) !== 0);
    assert.equal(frame.paused, (flags & 4) !== 0);
    sameFloats(frame.positions, content.positions);
    assert.deepEqual(frame.grabs, content.grabs);
    assert.deepEqual(frame.applied, content.applied);
    assert.deepEqual(frame.poses, content.poses);
    const named = frame.contacts.map(({ normalForce, ...rest }) => ({ ...rest, normal_force: normalForce }));
    assert.deepEqual(named, content.contacts);
    assert.deepEqual(frame.reactions, content.reactions);
    sameFloats(frame.velocities ?? [], content.velocities);
    assert.deepEqual(frame.grippers, content.grippers);
    assert.equal(frame.observed, (flags & 8) !== 0);
  }
});

test('golden meshes are read', () => {
  for (const { content, bytes } of binaryGoldens().filter(({ content }) => content.type === 'mesh')) {
    const mesh = decodeMesh(bytes);
    sameFloats(mesh.restPositions, content.rest_positions);
    sameFloats(mesh.uv, content.uv);
    assert.deepEqual([...mesh.triangles], content.triangles);
    assert.equal(mesh.colliders.length, content.colliders.length);
    content.colliders.forEach((expected, i) => {
      assert.equal(mesh.colliders[i].collider, expected.collider);
      sameFloats(mesh.colliders[i].positions, expected.positions);
      assert.deepEqual([...mesh.colliders[i].triangles], expected.triangles);
    });
  }
});

test('golden data is read', () => {
  for (const { content, bytes } of binaryGoldens().filter(({ content }) => content.type === 'data')) {
    const data = decodeData(bytes);
    assert.equal(data.tick, content.tick);
    assert.equal(data.transfer, content.transfer);
    assert.equal(data.components, content.components);
    assert.ok(data.values instanceof (content.format === 'f32' ? Float32Array : Float64Array));
    assert.deepEqual([...data.values], content.values);
  }
});

test('the type is told by the message itself', () => {
  for (const { content, bytes } of binaryGoldens()) {
    assert.equal(decodeBinary(bytes).type, content.type);
    for (const other of Object.keys(decoders))
      assert.equal(accepts(other, bytes), other === content.type);
  }
});

test('bytes that begin at an odd address are read as well', () => {
  for (const { bytes } of binaryGoldens()) {
    const shifted = new Uint8Array(bytes.length + 3);
    shifted.set(bytes, 3);
    assert.deepEqual(decodeBinary(shifted.subarray(3)), decodeBinary(bytes));
  }
});

test('the ack is the golden one', () => {
  assert.deepEqual(encodeAck(2 ** 32 - 2), readGolden('ack.bin'));
});

test('each message that breaks a rule is refused though its checksum is right', () => {
  for (const { type, rule, hex } of readGoldenJson('refused_binary.json'))
    assert.equal(accepts(type, Uint8Array.from(Buffer.from(hex, 'hex'))), false, `${type}: ${rule}`);
});

test('a message cut anywhere or with a byte more is refused', () => {
  for (const { name, content, bytes } of binaryGoldens()) {
    for (let length = 0; length < bytes.length; ++length)
      assert.equal(accepts(content.type, bytes.slice(0, length)), false, `${name} cut to ${length}`);
    assert.equal(accepts(content.type, Uint8Array.from([...bytes, 0])), false, name);
  }
});

test('a message with any one bit flipped is refused', () => {
  for (const { name, content, bytes } of binaryGoldens()) {
    for (let bit = 0; bit < 8 * bytes.length; ++bit) {
      const changed = bytes.slice();
      changed[bit >> 3] ^= 1 << (bit & 7);
      assert.equal(accepts(content.type, changed), false, `${name} bit ${bit}`);
    }
  }
});

// With length and checksum put right a decoder meets every later check. Whether it accepts is its
// business; it must throw nothing but ProtocolError.
test('bytes cut or changed behind a right checksum are survived', () => {
  let state = 7;
  const random = (below) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * below);
  };
  const count = { true: 0, false: 0 };
  for (const { content, bytes } of binaryGoldens()) {
    const survive = (changed) => (count[accepts(content.type, sealed(changed))] += 1);
    for (let length = 0; length <= bytes.length; ++length) survive(bytes.slice(0, length));
    for (let bit = 0; bit < 8 * bytes.length; ++bit) {
      const changed = bytes.slice();
      changed[bit >> 3] ^= 1 << (bit & 7);
      survive(changed);
    }
    for (let round = 0; round < 1000; ++round) {
      const changed = bytes.slice();
      for (let i = 0; i < 4; ++i) changed[random(changed.length)] = random(3) ? random(256) : 255;
      survive(changed);
    }
  }
  assert.ok(count.true > 1000 && count.false > 1000, JSON.stringify(count));
});

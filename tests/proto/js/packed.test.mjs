import assert from 'node:assert/strict';
import test from 'node:test';

import { FrameDecoder, ProtocolError, decodeFrame, decodeMesh, orderOf } from '../../../proto/js/index.js';
import { packedStreams, readGoldenJson, sealed } from './golden.mjs';

const bits = (floats) => new Uint32Array(floats.slice().buffer);

/** A decoder of a stream that has read so many frames. */
function decoderAfter({ order, frames }, count = 0) {
  const decoder = new FrameDecoder(order);
  for (const [packed] of frames.slice(0, count)) decoder.decode(packed);
  return decoder;
}

/** The frame, or null if it is refused; any other error than ProtocolError fails the test. */
function attempt(decoder, bytes) {
  try {
    return decoder.decode(bytes);
  } catch (error) {
    if (!(error instanceof ProtocolError)) throw error;
    return null;
  }
}

function randomNumbers(state) {
  return (below) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * below);
  };
}

function flipped(bytes, bit) {
  const changed = bytes.slice();
  changed[bit >> 3] ^= 1 << (bit & 7);
  return changed;
}

const small = () => packedStreams().filter(({ name }) => /\dx\d$/.test(name) && name !== 'packed_64x48');

test('packed golden frames are read bit for bit', () => {
  for (const stream of packedStreams()) {
    const decoder = decoderAfter(stream);
    for (const [packed, plain] of stream.frames) {
      const { positions, reference, ...rest } = decoder.decode(packed);
      const { positions: wanted, reference: own, ...others } = decodeFrame(plain);
      assert.deepEqual(bits(positions), bits(wanted), stream.name);
      assert.deepEqual({ ...rest, flags: rest.flags | 1, key: true }, others, stream.name);
    }
  }
});

test('a float32 frame between packed ones changes nothing for them', () => {
  const [stream] = packedStreams();
  const decoder = decoderAfter(stream);
  for (const [packed, plain] of stream.frames)
    assert.deepEqual(decoder.decode(plain).positions, decoder.decode(packed).positions);
});

test('each packed frame that breaks a rule is refused, and changes nothing', () => {
  const stream = packedStreams().find(({ name }) => name === 'packed_2x2');
  for (const { rule, after, hex } of readGoldenJson('packed.json').refused) {
    const decoder = decoderAfter(stream, after);
    assert.equal(attempt(decoder, Uint8Array.from(Buffer.from(hex, 'hex'))), null, rule);
    for (const [packed] of stream.frames.slice(after)) assert.ok(attempt(decoder, packed), rule);
  }
});

test('a frame whose reference was lost is refused until the next key', () => {
  const [stream] = packedStreams();
  const { frames } = readGoldenJson('packed.json')[stream.name];
  for (let lost = 1; lost < frames.length; ++lost) {
    const decoder = decoderAfter(stream, lost);
    let missing = true;
    for (let n = lost + 1; n < frames.length; ++n) {
      missing &&= !frames[n].key;
      assert.equal(attempt(decoder, stream.frames[n][0]) === null, missing);
    }
  }
});

test('a packed frame needs a decoder that keeps frames', () => {
  const [packed] = packedStreams()[0].frames[0];
  assert.throws(() => decodeFrame(packed), ProtocolError);
});

test('a packed frame cut anywhere, with a byte more or with any one bit flipped is refused', () => {
  for (const stream of small()) {
    stream.frames.forEach(([packed], n) => {
      const decoder = decoderAfter(stream, n);
      for (let length = 0; length < packed.length; ++length) {
        assert.equal(attempt(decoder, packed.slice(0, length)), null);
        assert.equal(attempt(decoder, sealed(packed.slice(0, length))), null);
      }
      assert.equal(attempt(decoder, Uint8Array.from([...packed, 0])), null);
      for (let bit = 0; bit < 8 * packed.length; ++bit)
        assert.equal(attempt(decoder, flipped(packed, bit)), null);
      assert.ok(attempt(decoder, packed));
    });
  }
});

test('packed bytes changed behind a right checksum are survived', () => {
  const random = randomNumbers(7);
  const count = { read: 0, refused: 0 };
  const streams = packedStreams().filter(({ name }) => /meshes|extremes|\dx\d$/.test(name));
  for (const stream of streams.filter(({ name }) => name !== 'packed_64x48')) {
    stream.frames.forEach(([packed, plain], n) => {
      const before = decoderAfter(stream, n);
      for (let round = 0; round < 200; ++round) {
        let changed = packed.slice();
        for (let i = 0; i <= random(4); ++i)
          changed[64 + random(changed.length - 64)] = random(3) ? random(256) : 255;
        if (random(4) === 0) changed = changed.slice(0, 64 + random(changed.length - 64));
        const frame = attempt(before, sealed(changed));
        count[frame ? 'read' : 'refused'] += 1;
        if (!frame) continue;
        assert.equal(frame.positions.length, decodeFrame(plain).positions.length);
        break; // the decoder has gone on
      }
    });
  }
  assert.ok(count.refused > 3000, JSON.stringify(count));
});

test('an order that is none is refused with its mesh', () => {
  const { mesh, cloths } = packedStreams().find(({ name }) => name === 'packed_meshes');
  const data = decodeMesh(mesh);
  assert.ok(data.order.length > 0);
  for (const [at, word] of [[0, 1000], [4, data.order[0]], [4 * 10 + 1, 10], [4 * 10 + 3, 2 ** 32 - 2]]) {
    const order = data.order.slice();
    order[at] = word;
    assert.throws(() => orderOf(cloths, { ...data, order }), ProtocolError);
  }
  assert.throws(() => orderOf(cloths, { ...data, order: null }), ProtocolError);
});

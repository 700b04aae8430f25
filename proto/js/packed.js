// The codec `packed` (proto/README.md section 10): positions as whole numbers that build on earlier
// frames. Survives any bytes: it throws nothing but ProtocolError, and then has changed nothing.

import { demand, demandFinite } from './bytes.js';
import { decodeFrame } from './codec.js';
import { EntropyDecoder } from './entropy.js';
import { BLEND, STRAIGHT, addEarlier, addNeighbours } from './prediction.js';

const FIXED_BYTES = 20;
const KEY_BYTES = FIXED_BYTES + 24;
const MOST_STEPS = 2 ** 20;
const SURELY_FINITE = 1e38; // coordinates below are finite as float32 too

/**
 * @typedef {import('./entropy.js').Order} Order
 * @typedef {import('./codec.js').PackedHeader} PackedHeader
 * @typedef {{numbers: Int32Array, sequence: number}} Held
 * @typedef {{base: number, neighbours: number, before: number, rawLength: number,
 *   sumA: number, sumB: number, origin: number[] | null, coded: Uint8Array}} Payload
 */

/**
 * Reads and checks what precedes the tokens.
 * @param {Uint8Array} bytes
 * @param {boolean} key
 * @returns {Payload}
 */
function readPayload(bytes, key) {
  demand(bytes.length >= (key ? KEY_BYTES : FIXED_BYTES), 'the packed positions are cut off');
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const [base, neighbours] = bytes;
  const known = base <= STRAIGHT && neighbours <= BLEND && view.getUint16(2, true) === 0;
  demand(known, 'the prediction is unknown');
  demand(!key || base === 0, 'a key frame builds on no other');
  const before = view.getUint32(4, true);
  demand(base === STRAIGHT || before === 0, 'a frame is named that is not needed');
  const origin = key ? [20, 28, 36].map((at) => view.getFloat64(at, true)) : null;
  demand(origin === null || origin.every(Number.isFinite), 'the origin is not finite');
  return {
    base,
    neighbours,
    before,
    rawLength: view.getUint32(8, true),
    sumA: view.getUint32(12, true),
    sumB: view.getUint32(16, true),
    origin,
    coded: bytes.subarray(key ? KEY_BYTES : FIXED_BYTES),
  };
}

/** Decodes the frames of one mesh in either codec, in the order in which they were sent. */
export class FrameDecoder {
  #order;
  #stride;
  #entropy = new EntropyDecoder();
  /** @type {Held | null} */
  #last = null;
  /** @type {Held | null} */
  #before = null;
  /** @type {Int32Array} */
  #scratch;
  #step = 0;
  #origin = [0, 0, 0];

  /** @param {Order} order */
  constructor(order) {
    this.#order = order;
    this.#stride = order.vertices.length + 1;
    this.#scratch = new Int32Array(3 * this.#stride);
  }

  /**
   * @param {ArrayBuffer | ArrayBufferView} bytes
   * @returns {import('./messages.js').Frame}
   */
  decode(bytes) {
    return decodeFrame(bytes, (header, payload) => this.#unpack(header, payload));
  }

  /** The whole numbers of the last packed frame: three planes, each with a 0 behind it. */
  get numbers() {
    return this.#last?.numbers ?? null;
  }

  /**
   * @param {PackedHeader} header
   * @param {Uint8Array} bytes
   */
  #unpack({ key, sequence, reference, step, vertices }, bytes) {
    demand(vertices === this.#stride - 1, 'the frame does not fit the mesh');
    const payload = readPayload(bytes, key);
    const last = key ? null : this.#last;
    const before = key ? null : this.#before;
    demand(key || last?.sequence === reference, 'a frame that this one builds on is missing');
    demand(key || step === this.#step, 'the step changes without a key frame');
    const straight = payload.base === STRAIGHT;
    demand(!straight || before?.sequence === payload.before, 'the frame before is missing');
    const numbers = this.#scratch;
    this.#entropy.decode(payload.coded, payload.rawLength, this.#order, numbers);
    for (let plane = 0; plane < 3; ++plane)
      addNeighbours(payload.neighbours, this.#order, numbers.subarray(plane * this.#stride));
    if (last) addEarlier(payload.base, numbers, last.numbers, (before ?? last).numbers);
    const origin = payload.origin ?? this.#origin;
    const positions = this.#place(numbers, payload, origin, step);
    // From here on nothing fails. The buffer of the frame that is forgotten is used again.
    this.#scratch = this.#before?.numbers ?? new Int32Array(3 * this.#stride);
    if (key && this.#last) this.#scratch = this.#last.numbers;
    this.#before = last;
    this.#last = { numbers, sequence };
    this.#step = step;
    this.#origin = origin;
    return positions;
  }

  /**
   * Numbers to coordinates, with all checks of the numbers.
   * @param {Int32Array} numbers
   * @param {Payload} payload
   * @param {number[]} origin
   * @param {number} step
   */
  #place(numbers, payload, origin, step) {
    const { vertices } = this.#order;
    const count = vertices.length;
    const stride = this.#stride;
    const [x, y, z] = origin;
    const positions = new Float32Array(3 * count);
    let sumA = 0;
    let sumB = 0;
    let outside = 0;
    for (let i = 0; i < count; ++i) {
      const kx = numbers[i];
      const ky = numbers[stride + i];
      const kz = numbers[2 * stride + i];
      const sum = (kx + ky + kz) | 0;
      sumA = (sumA + sum) | 0;
      // Their places in the order of the sums are i + 1, and count and 2 count later.
      sumB = (sumB + Math.imul(i + 1, sum) + Math.imul(count, (ky + kz + kz) | 0)) | 0;
      outside |= (kx + MOST_STEPS - 1) | (MOST_STEPS - 1 - kx);
      outside |= (ky + MOST_STEPS - 1) | (MOST_STEPS - 1 - ky);
      outside |= (kz + MOST_STEPS - 1) | (MOST_STEPS - 1 - kz);
      const at = 3 * vertices[i];
      positions[at] = x + kx * step;
      positions[at + 1] = y + ky * step;
      positions[at + 2] = z + kz * step;
    }
    demand(outside >= 0, 'a number is out of range');
    const right = sumA >>> 0 === payload.sumA && sumB >>> 0 === payload.sumB;
    demand(right, 'the sums of the numbers do not match');
    const farthest = Math.max(...origin.map(Math.abs)) + MOST_STEPS * step;
    if (farthest > SURELY_FINITE) demandFinite(positions);
    return positions;
  }
}

// Tokens of the codec `packed` (proto/README.md section 10): tables of frequencies, rANS with two
// states, raw bits. Survives any bytes: it throws nothing but ProtocolError.

import { demand } from './bytes.js';

const CONTEXTS = 10;
const MOST_TOKENS = 58;
const SLOTS = 4096;
const STATE_LOW = 2 ** 23;
const CHECK_EVERY = 64; // values between two looks at the cursors
const PADDING = 3 * CHECK_EVERY + 8; // they take at most 2 coded and 3 raw bytes each
const LAST_CLASS = 251; // sums from here on are of the last context

const UNUSED = -(2 ** 31); // marks the slots of a context that does not occur

/** Where the slots of the context of a sum begin. */
const TABLE_OF = new Int32Array(LAST_CLASS + 1);
for (let sum = 0; sum <= LAST_CLASS; ++sum) {
  const context = [0, 1, 2, 4, 8, 16, 40, 100, 250, Infinity].findIndex((most) => sum <= most);
  TABLE_OF[sum] = context * SLOTS;
}
const LAST_TABLE = TABLE_OF[LAST_CLASS];

/**
 * Places of vertices in coding order, and of their neighbours; a missing one is the number of
 * vertices. If all cloths are grids: from where to where each goes, row by row.
 * @typedef {{first: number, end: number, columns: number}} Grid
 * @typedef {{vertices: Uint32Array, a: Uint32Array, b: Uint32Array, c: Uint32Array,
 *   grids: Grid[] | null}} Order
 */

export class EntropyDecoder {
  // Of each slot its token from bit 24 on, the frequencies below that added up from bit 12 on, and
  // its own less one, so that one look tells all.
  #slots = new Int32Array(CONTEXTS * SLOTS);
  #buffer = new Uint8Array(0);
  #words = new DataView(this.#buffer.buffer);
  // Where reading stands.
  #now = 0;
  #next = 0;
  #coded = 0;
  #bit = 0;

  /**
   * Reads three planes of residuals, zigzag; or throws ProtocolError.
   * @param {Uint8Array} bytes      tables, states, coded bytes and raw bits
   * @param {number} rawLength      of the raw bits [bytes]
   * @param {Order} order
   * @param {Int32Array} residuals  three planes of as many places and one, which gets 0
   */
  decode(bytes, rawLength, order, residuals) {
    const codedEnd = bytes.length - rawLength;
    demand(codedEnd >= 0, 'the raw bits are cut off');
    let at = 0;
    for (let context = 0; context < CONTEXTS; ++context)
      at = this.#readTable(bytes, at, codedEnd, context);
    demand(at + 8 <= codedEnd, 'the states are cut off');
    const view = new DataView(bytes.buffer, bytes.byteOffset + at, 8);
    this.#now = view.getUint32(0, true);
    this.#next = view.getUint32(4, true);
    for (const state of [this.#now, this.#next])
      demand(state >= STATE_LOW && state < 256 * STATE_LOW, 'a state is out of range');
    const codedLength = codedEnd - (at + 8);
    this.#fill(bytes.subarray(at + 8, codedEnd), bytes.subarray(codedEnd));
    const raw = codedLength + PADDING;
    this.#coded = 0;
    this.#bit = 8 * raw;
    const stride = order.vertices.length + 1;
    for (let plane = 0; plane < 3; ++plane)
      this.#decodePlane(
        codedLength,
        8 * (raw + rawLength),
        order,
        residuals.subarray(plane * stride, (plane + 1) * stride),
      );
    const rest = 8 * (raw + rawLength) - this.#bit;
    const empty = rest < 8 && (rest === 0 || this.#buffer[raw + rawLength - 1] >> (8 - rest) === 0);
    const ended = this.#now === STATE_LOW && this.#next === STATE_LOW && this.#coded === codedLength;
    demand(ended && empty, 'the packed positions do not end as they should');
  }

  /**
   * @param {Uint8Array} coded
   * @param {Uint8Array} raw
   */
  #fill(coded, raw) {
    const needed = coded.length + raw.length + 2 * PADDING;
    if (this.#buffer.length < needed) {
      this.#buffer = new Uint8Array(2 * needed);
      this.#words = new DataView(this.#buffer.buffer);
    }
    this.#buffer.set(coded);
    this.#buffer.fill(0, coded.length, coded.length + PADDING);
    this.#buffer.set(raw, coded.length + PADDING);
    this.#buffer.fill(0, needed - PADDING, needed);
  }

  /**
   * @param {Uint8Array} bytes
   * @param {number} at
   * @param {number} end
   * @param {number} context
   */
  #readTable(bytes, at, end, context) {
    demand(at < end, 'a table is cut off');
    const count = bytes[at++];
    demand(count <= MOST_TOKENS, 'too many tokens');
    const table = context * SLOTS;
    if (count === 0) this.#slots.fill(UNUSED, table, table + SLOTS);
    let start = 0;
    for (let token = 0; token < count; ++token) {
      demand(at < end, 'a table is cut off');
      let f = bytes[at++];
      if (f >= 128) {
        demand(at < end, 'a table is cut off');
        f = (f & 127) | (bytes[at++] << 7);
      }
      demand(f <= SLOTS - start, 'frequencies are too large');
      if (f === 0) continue;
      this.#slots.fill((token << 24) | (start << 12) | (f - 1), table + start, table + start + f);
      start += f;
    }
    demand(count === 0 || start === SLOTS, 'frequencies do not add up');
    return at;
  }

  /**
   * @param {number} codedEnd
   * @param {number} bitEnd
   * @param {Order} order
   * @param {Int32Array} residuals
   */
  #decodePlane(codedEnd, bitEnd, { vertices, a, b }, residuals) {
    const count = vertices.length;
    const slots = this.#slots;
    const buffer = this.#buffer;
    const words = this.#words;
    let now = this.#now;
    let next = this.#next;
    let coded = this.#coded;
    let bit = this.#bit;
    let unused = 0; // negative once a slot was
    residuals[count] = 0;
    for (let begin = 0; begin < count; begin += CHECK_EVERY) {
      const end = Math.min(count, begin + CHECK_EVERY);
      for (let i = begin; i < end; ++i) {
        // Residuals stay below 2^25, so that their sum is a small integer.
        const around = residuals[a[i]] + residuals[b[i]];
        const table = around < LAST_CLASS ? TABLE_OF[around] : LAST_TABLE;
        const slot = now & (SLOTS - 1);
        const share = slots[table | slot];
        unused |= share;
        const token = (share >> 24) & 63;
        const below = (share >> 12) & (SLOTS - 1);
        let x = (Math.imul((share & (SLOTS - 1)) + 1, now >>> 12) + slot - below) | 0;
        // Whether a byte is due is as good as random, so that a branch would cost more than this:
        // all ones if it is. A second one is rare.
        const due = (x - STATE_LOW) >> 31;
        x = (x << (due & 8)) | (buffer[coded] & due);
        coded -= due;
        if (x < STATE_LOW) x = (x << 8) | buffer[coded++];
        now = next;
        next = x;
        let value = token;
        if (token >= 16) {
          const low = ((token - 16) >> 1) + 3;
          const word = words.getInt32(bit >> 3, true) >>> (bit & 7);
          value = ((2 + (token & 1)) << low) | (word & ((1 << low) - 1));
          bit += low;
        }
        residuals[i] = value;
      }
      demand(unused >= 0, 'a context that does not occur');
      demand(coded <= codedEnd && bit <= bitEnd, 'the packed positions are cut off');
    }
    this.#now = now;
    this.#next = next;
    this.#coded = coded;
    this.#bit = bit;
  }
}

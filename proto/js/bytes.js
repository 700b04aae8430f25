// Common to all binary messages of weft.v1 (proto/README.md section 6): header, checksum, sections.

/** Bytes that do not form a message of weft.v1. */
export class ProtocolError extends Error {
  /** @param {string} message */
  constructor(message) {
    super(message);
    this.name = 'ProtocolError';
  }
}

const VERSION = 1;
const COMMON_BYTES = 16;
const SECTION_BYTES = 8;

/**
 * @typedef {{kind: number, index: number, offset: number, length: number}} Section
 * @typedef {{type: number, codec: number, flags: number, view: DataView}} Message
 */

/**
 * @param {boolean} condition
 * @param {string} message
 * @returns {asserts condition}
 */
export function demand(condition, message) {
  if (!condition) throw new ProtocolError(message);
}

/** @param {number} bytes */
export const padded = (bytes) => Math.ceil(bytes / 8) * 8;

/**
 * A view that starts at an offset fit for typed arrays; copies only if necessary.
 * @param {ArrayBuffer | ArrayBufferView} bytes
 */
function alignedView(bytes) {
  if (bytes instanceof ArrayBuffer) return new DataView(bytes);
  const { buffer, byteOffset, byteLength } = bytes;
  if (byteOffset % 8 === 0) return new DataView(buffer, byteOffset, byteLength);
  return new DataView(new Uint8Array(buffer, byteOffset, byteLength).slice().buffer);
}

/** @param {DataView} view */
function checksum(view) {
  // Signed, so that engines add integers; the sums modulo 2^32 are the same.
  const words = new Int32Array(view.buffer, view.byteOffset, view.byteLength / 4);
  let a = 0;
  let b = 0;
  for (let j = 0; j < words.length; ++j) {
    a = (a + words[j]) | 0;
    b = (b + Math.imul(words[j], j + 1)) | 0;
  }
  // Without the sums themselves, words 2 and 3.
  a = (a - words[2] - words[3]) | 0;
  b = (b - Math.imul(words[2], 3) - Math.imul(words[3], 4)) | 0;
  return [a >>> 0, b >>> 0];
}

/**
 * Checks the parts common to all messages.
 * @param {ArrayBuffer | ArrayBufferView} bytes
 * @returns {Message}
 */
export function readMessage(bytes) {
  const view = alignedView(bytes);
  demand(view.byteLength >= COMMON_BYTES, 'the message is too short');
  demand(view.getUint8(1) === VERSION, 'unknown version');
  const fits = view.getUint32(4, true) === view.byteLength && view.byteLength % 8 === 0;
  demand(fits, 'the length does not match');
  const [a, b] = checksum(view);
  const right = a === view.getUint32(8, true) && b === view.getUint32(12, true);
  demand(right, 'the checksum does not match');
  return { type: view.getUint8(0), codec: view.getUint8(2), flags: view.getUint8(3), view };
}

/**
 * @param {DataView} view
 * @param {number} offset
 */
export function readTick(view, offset) {
  const high = view.getUint32(offset + 4, true);
  demand(high < 2 ** 21, 'the tick is too large');
  return high * 2 ** 32 + view.getUint32(offset, true);
}

/**
 * @param {DataView} view
 * @param {number} start
 * @param {number} end
 */
export function demandZero(view, start, end) {
  for (let i = start; i < end; ++i) demand(view.getUint8(i) === 0, 'padding is not zero');
}

/**
 * @param {DataView} view
 * @param {number} offset
 * @param {number} count
 * @returns {Section[]}
 */
export function readSections(view, offset, count) {
  const sections = [];
  const names = new Set();
  for (let i = 0; i < count; ++i) {
    demand(view.byteLength - offset >= SECTION_BYTES, 'a section is cut off');
    const kind = view.getUint16(offset, true);
    const index = view.getUint16(offset + 2, true);
    const length = view.getUint32(offset + 4, true);
    offset += SECTION_BYTES;
    demand(length <= view.byteLength - offset, 'a section is too long');
    const next = offset + padded(length);
    demandZero(view, offset + length, next);
    const name = kind * 65536 + index;
    demand(!names.has(name), 'a section appears twice');
    names.add(name);
    sections.push({ kind, index, offset, length });
    offset = next;
  }
  demand(offset === view.byteLength, 'bytes are left over');
  return sections;
}

/** @param {Float32Array | Float64Array} values */
export function demandFinite(values) {
  // A sum of finite numbers may overflow, so each is checked.
  for (let i = 0; i < values.length; ++i)
    demand(Number.isFinite(values[i]), 'a number is not finite');
  return values;
}

/**
 * @param {DataView} view
 * @param {Section | undefined} section
 * @param {number} count  of floats
 */
export function readFloats(view, section, count) {
  demand(section !== undefined && section.length === count * 4, 'a section does not fit');
  const values = new Float32Array(view.buffer, view.byteOffset + section.offset, count);
  demandFinite(values);
  return values;
}

// Lists and arrays in the sections of a frame (proto/README.md section 6).

import { demand, readFloats } from './bytes.js';

/**
 * @typedef {import('./bytes.js').Section} Section
 * @typedef {(kind: number) => Section | undefined} Find
 */

/**
 * @template Entry
 * @param {Section | undefined} section  absent: the list is empty
 * @param {number} bytes  of an entry
 * @param {(at: number) => Entry} read
 */
export function readList(section, bytes, read) {
  /** @type {Entry[]} */
  const entries = [];
  if (!section) return entries;
  demand(section.length % bytes === 0, 'a section does not fit');
  const end = section.offset + section.length;
  for (let at = section.offset; at < end; at += bytes) entries.push(read(at));
  return entries;
}

/**
 * @param {DataView} view
 * @param {Section | undefined} section
 * @param {number} count  of floats
 */
export function readArray(view, section, count) {
  return section ? readFloats(view, section, count) : null;
}

/**
 * @param {DataView} view
 * @param {number} at
 */
export function readNumber(view, at) {
  const number = view.getFloat32(at, true);
  demand(Number.isFinite(number), 'a number is not finite');
  return number;
}

/**
 * @param {DataView} view
 * @param {number} at
 * @param {number} count
 */
export function readVector(view, at, count) {
  const numbers = [];
  for (let i = 0; i < count; ++i) numbers.push(readNumber(view, at + 4 * i));
  return numbers;
}

/**
 * @template {string} Word
 * @param {DataView} view
 * @param {number} at
 * @param {Word[]} words
 * @returns {Word | number}  the number itself, if this client does not know its meaning
 */
export function readWord(view, at, words) {
  const number = view.getUint32(at, true);
  return words[number] ?? number;
}

/**
 * A place in a list, or null.
 * @param {DataView} view
 * @param {number} at
 * @param {number} none  stands for none
 */
export function readPlace(view, at, none) {
  const place = view.getUint32(at, true);
  return place === none ? null : place;
}

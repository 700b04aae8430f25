// Binary messages of weft.v1 (proto/README.md sections 6 to 8). Received bytes are checked before
// use; for any input, a decoder returns a message or throws ProtocolError.

import {
  ProtocolError,
  demand,
  demandFinite,
  demandZero,
  padded,
  readFloats,
  readMessage,
  readSections,
  readTick,
} from './bytes.js';
import { readOrder } from './order.js';
import { readParts } from './samples.js';

export { ProtocolError } from './bytes.js';

const FRAME = 1;
const MESH = 2;
const DATA = 3;
const ACK = 4;
const VERSION = 1;
const FRAME_BYTES = 64;
const MESH_BYTES = 32;
const DATA_BYTES = 40;
const MOST_COMPONENTS = 16;
const FLOAT32 = 0;
const PACKED = 2;
const FLAG_KEY = 1;

const KIND = {
  positions: 1,
  packedPositions: 7,
  restPositions: 16,
  triangles: 17,
  uv: 18,
  colliderPositions: 19,
  colliderTriangles: 20,
  order: 21,
};

/**
 * @typedef {import('./messages.js').Frame} Frame
 * @typedef {import('./messages.js').MeshData} MeshData
 * @typedef {import('./messages.js').Data} Data
 * @typedef {import('./bytes.js').Section} Section
 * @typedef {import('./bytes.js').Message} Message
 * @typedef {{key: boolean, sequence: number, reference: number, step: number, vertices: number}}
 *   PackedHeader
 * @typedef {(header: PackedHeader, payload: Uint8Array) => Float32Array} Unpack  of packed positions
 */

/**
 * @param {DataView} view
 * @param {Section | undefined} section
 * @param {number} count  of triangles
 * @param {number} vertices
 */
function readTriangles(view, section, count, vertices) {
  demand(section !== undefined && section.length === count * 12, 'a section does not fit');
  const indices = new Uint32Array(view.buffer, view.byteOffset + section.offset, count * 3);
  for (let i = 0; i < indices.length; ++i)
    demand(indices[i] < vertices, 'an index is out of range');
  return indices;
}

/** @type {Unpack} */
function unpackNothing() {
  throw new ProtocolError('a packed frame builds on earlier ones: FrameDecoder reads it');
}

/**
 * Checks how a frame says that it is coded.
 * @param {Message} message
 * @returns {PackedHeader}
 */
function readPackedHeader({ codec, flags, view }) {
  demand(codec === FLOAT32 || codec === PACKED, 'unknown codec');
  demand(view.byteLength >= FRAME_BYTES, 'the message is too short');
  const key = (flags & FLAG_KEY) !== 0;
  const sequence = view.getUint32(40, true);
  const reference = view.getUint32(44, true);
  const step = view.getFloat32(56, true);
  demand(key === (reference === sequence), 'a key frame builds on no other');
  const fits = codec === FLOAT32 ? key && step === 0 : Number.isFinite(step) && step > 0;
  demand(fits, 'the step does not fit the codec');
  return { key, sequence, reference, step, vertices: view.getUint32(52, true) };
}

/**
 * @param {Message} message
 * @param {Unpack} unpack
 * @returns {Frame}
 */
function readFrame(message, unpack) {
  const { codec, flags, view } = message;
  const header = readPackedHeader(message);
  const time = view.getFloat64(24, true);
  const serverTime = view.getFloat64(32, true);
  demand(Number.isFinite(time) && Number.isFinite(serverTime), 'a time is not finite');
  const sections = readSections(view, FRAME_BYTES, view.getUint32(60, true));
  /** @param {number} kind */
  const find = (kind) => sections.find((s) => s.kind === kind && s.index === 0);
  /** Last of all: from there on packed frames build on this one. */
  const positions = () => {
    if (codec === FLOAT32) return readFloats(view, find(KIND.positions), header.vertices * 3);
    const packed = find(KIND.packedPositions);
    demand(packed !== undefined, 'the frame has no positions');
    return unpack(header, new Uint8Array(view.buffer, view.byteOffset + packed.offset, packed.length));
  };
  return {
    type: 'frame',
    ...readParts(flags, view, find, header.vertices),
    tick: readTick(view, 16),
    time,
    serverTime,
    sequence: header.sequence,
    reference: header.reference,
    epoch: view.getUint32(48, true),
    positions: positions(),
  };
}

/**
 * @param {DataView} view
 * @param {Section | undefined} section  absent if all cloths are grids
 * @param {number} vertices
 */
function readOrderWords(view, section, vertices) {
  if (!section) return null;
  demand(section.length === vertices * 16, 'a section does not fit');
  const words = new Uint32Array(view.buffer, view.byteOffset + section.offset, vertices * 4);
  readOrder(words);
  return words;
}

/**
 * @param {DataView} view
 * @param {Section[]} sections
 */
function readColliders(view, sections) {
  const colliders = [];
  for (const corners of sections.filter((s) => s.kind === KIND.colliderPositions)) {
    const faces = sections.find((s) => s.kind === KIND.colliderTriangles && s.index === corners.index);
    demand(faces !== undefined, 'a collider has no triangles');
    const vertices = Math.floor(corners.length / 12);
    colliders.push({
      collider: corners.index,
      positions: readFloats(view, corners, vertices * 3),
      triangles: readTriangles(view, faces, Math.floor(faces.length / 12), vertices),
    });
  }
  return colliders.sort((a, b) => a.collider - b.collider);
}

/**
 * @param {Message} message
 * @returns {MeshData}
 */
function readMesh({ codec, view }) {
  demand(codec === 0, 'unknown codec');
  demand(view.byteLength >= MESH_BYTES, 'the message is too short');
  const [vertices, triangles, colliderMeshes, count] = [16, 20, 24, 28].map((offset) =>
    view.getUint32(offset, true),
  );
  const sections = readSections(view, MESH_BYTES, count);
  /** @param {number} kind */
  const find = (kind) => sections.find((s) => s.kind === kind && s.index === 0);
  const faces = sections.filter((s) => s.kind === KIND.colliderTriangles).length;
  const colliders = readColliders(view, sections);
  const promised = colliders.length === colliderMeshes && faces === colliderMeshes;
  demand(promised, 'the number of collider meshes does not fit');
  return {
    type: 'mesh',
    restPositions: readFloats(view, find(KIND.restPositions), vertices * 3),
    triangles: readTriangles(view, find(KIND.triangles), triangles, vertices),
    uv: readFloats(view, find(KIND.uv), vertices * 2),
    order: readOrderWords(view, find(KIND.order), vertices),
    colliders,
  };
}

/**
 * @param {Message} message
 * @returns {Data}
 */
function readData({ codec, view }) {
  demand(codec <= 1, 'unknown codec');
  demand(view.byteLength >= DATA_BYTES, 'the message is too short');
  const count = view.getUint32(28, true);
  const components = view.getUint32(32, true);
  const sane = components >= 1 && components <= MOST_COMPONENTS && view.getUint32(36, true) === 0;
  demand(sane, 'the header does not fit');
  const bytes = count * components * (codec === 0 ? 4 : 8);
  demand(view.byteLength === DATA_BYTES + padded(bytes), 'the values do not fit');
  demandZero(view, DATA_BYTES + bytes, view.byteLength);
  const start = view.byteOffset + DATA_BYTES;
  const values =
    codec === 0
      ? new Float32Array(view.buffer, start, count * components)
      : new Float64Array(view.buffer, start, count * components);
  demandFinite(values);
  return {
    type: 'data',
    tick: readTick(view, 16),
    transfer: view.getUint32(24, true),
    components,
    values,
  };
}

/**
 * Reads any binary message of a server. Arrays are views into the bytes, which must not change.
 * @param {ArrayBuffer | ArrayBufferView} bytes
 * @returns {Frame | MeshData | Data}
 */
export function decodeBinary(bytes) {
  const message = readMessage(bytes);
  if (message.type === FRAME) return readFrame(message, unpackNothing);
  if (message.type === MESH) return readMesh(message);
  demand(message.type === DATA, 'unknown type');
  return readData(message);
}

/**
 * @param {ArrayBuffer | ArrayBufferView} bytes
 * @param {Unpack} [unpack]  of a packed frame's positions; by default those are refused
 * @returns {Frame}
 */
export function decodeFrame(bytes, unpack = unpackNothing) {
  const message = readMessage(bytes);
  demand(message.type === FRAME, 'not a frame');
  return readFrame(message, unpack);
}

/**
 * @param {ArrayBuffer | ArrayBufferView} bytes
 * @returns {MeshData}
 */
export function decodeMesh(bytes) {
  const message = readMessage(bytes);
  demand(message.type === MESH, 'not a mesh');
  return readMesh(message);
}

/**
 * @param {ArrayBuffer | ArrayBufferView} bytes
 * @returns {Data}
 */
export function decodeData(bytes) {
  const message = readMessage(bytes);
  demand(message.type === DATA, 'not data');
  return readData(message);
}

/**
 * The answer to a frame.
 * @param {number} sequence  of the frame
 */
export function encodeAck(sequence) {
  const bytes = new Uint8Array(8);
  bytes.set([ACK, VERSION]);
  new DataView(bytes.buffer).setUint32(4, sequence, true);
  return bytes;
}

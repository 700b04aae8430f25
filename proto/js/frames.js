import { readMessage } from './bytes.js';
import { decodeFrame } from './codec.js';
import { orderOf } from './order.js';
import { FrameDecoder } from './packed.js';

const PACKED = 2;
const KEY = 1;
const FRAME_BYTES = 64;
const SEQUENCE_AT = 40; // in the bytes of a frame
const KEY_PATIENCE = 1000; // until a key is asked for again [ms]

/**
 * What became of a frame: null if it builds on frames that this client has not got, so that it
 * needs a key; early if it came before its mesh, so that a key would come too early as well.
 * @typedef {{sequence: number, frame: import('./messages.js').Frame | null, early?: boolean}} Received
 *
 * @typedef {object} FrameSource  reads a connection's frames, here or in a worker
 * @property {(cloths: import('./messages.js').Cloth[],
 *   data: {restPositions: Float32Array, order: Uint32Array | null}) => void} begin  a mesh came
 * @property {(bytes: ArrayBuffer, done: (received: Received) => void,
 *   fail: (error: Error) => void) => void} read  calls one of both, in the order of the frames; may
 *   throw ProtocolError instead
 */

/**
 * Reads the frames of a connection in either codec, in the order in which they were sent.
 * @implements {FrameSource}
 */
export class FrameReader {
  /** @type {(() => FrameDecoder) | null} */
  #make = null;
  /** @type {FrameDecoder | null} */
  #decoder = null;

  /** @type {FrameSource['begin']} */
  begin(cloths, data) {
    this.#make = () => new FrameDecoder(orderOf(cloths, data)); // once packed frames come
    this.#decoder = null;
  }

  /** @type {FrameSource['read']} */
  read(bytes, done) {
    done(this.take(bytes));
  }

  /**
   * @param {ArrayBuffer | ArrayBufferView} bytes
   * @returns {Received}
   */
  take(bytes) {
    const { codec, flags, view } = readMessage(bytes);
    if (codec !== PACKED || view.byteLength < FRAME_BYTES) {
      const frame = decodeFrame(bytes);
      return { sequence: frame.sequence, frame };
    }
    const sequence = view.getUint32(SEQUENCE_AT, true);
    const lost = !this.#make || (!this.#decoder && (flags & KEY) === 0);
    if (lost) return { sequence, frame: null };
    this.#decoder ??= /** @type {() => FrameDecoder} */ (this.#make)();
    return { sequence, frame: this.#decoder.decode(bytes) };
  }
}

/**
 * A source whose frames may be decoded elsewhere. Those of a connection that is lost meanwhile are
 * dropped: what follows is of another one, and perhaps of another server. Packed frames that come
 * while a mesh is fetched are passed over, because the source still has the order of the one before.
 * @implements {FrameSource}
 */
export class LiveFrames {
  #source;
  #losses = 0;
  #meshless = false;

  /** @param {FrameSource} source */
  constructor(source) {
    this.#source = source;
  }

  /** @type {FrameSource['begin']} */
  begin(cloths, data) {
    this.#meshless = false;
    this.#source.begin(cloths, data);
  }

  /** A mesh is announced, and what follows is of it; `begin` tells that it is here. */
  expectMesh() {
    this.#meshless = true;
  }

  /** @type {FrameSource['read']} */
  read(bytes, done, fail) {
    const sequence = this.#meshless ? packedSequence(bytes) : null;
    if (sequence !== null) return done({ sequence, frame: null, early: true });
    const losses = this.#losses;
    const live = () => losses === this.#losses;
    this.#source.read(bytes, (got) => live() && done(got), (error) => live() && fail(error));
  }

  /** The connection is lost. */
  drop() {
    this.#losses += 1;
  }
}

/**
 * The number of a packed frame, which stands where it stands in any frame; null if it is no such frame.
 * @param {ArrayBuffer} bytes
 */
function packedSequence(bytes) {
  const { codec, view } = readMessage(bytes);
  return codec === PACKED && view.byteLength >= FRAME_BYTES ? view.getUint32(SEQUENCE_AT, true) : null;
}

/**
 * When to ask for a key. While one is under way none is asked for; but the request may have been
 * refused, as when too many messages came.
 */
export class KeyWish {
  #timers;
  #askedAt = -Infinity; // [ms]
  #deferred = false;

  /** @param {import('./connection.js').Timers} timers */
  constructor(timers) {
    this.#timers = timers;
  }

  /** A frame could not be read. @returns whether to ask now */
  renew() {
    const now = this.#timers.now();
    if (now - this.#askedAt < KEY_PATIENCE) return false;
    this.#askedAt = now;
    return true;
  }

  /** A frame came before its mesh. */
  defer() {
    this.#deferred = true;
  }

  /** The mesh is here; a key that was asked for before it is of no use. @returns whether to ask now */
  resume() {
    if (!this.#deferred) return false;
    this.#deferred = false;
    this.fulfil();
    return this.renew();
  }

  /** Frames can be read. */
  fulfil() {
    this.#askedAt = -Infinity;
  }
}

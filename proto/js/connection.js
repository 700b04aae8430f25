import { Emitter } from './emitter.js';

const SUBPROTOCOL = 'weft.v1';
const OPEN = 1; // readyState of a socket
const FIRST_PAUSE = 250; // before the first new attempt [ms]
const LONGEST_PAUSE = 8000; // [ms]
const OPENING_LIMIT = 10000; // for the handshake [ms]
/** In which events that waited behind a long task of this thread arrive, before time is up [ms]. */
export const SECOND_LOOK = 50;
const NORMAL_CLOSE = 1000;
// Close codes after which a new attempt would fail alike.
const FINAL_CODES = new Set([1002, 1003, 1007, 1008, 1009, 4003, 4004]);

/**
 * @typedef {object} Timers  the system's clock, or a test's
 * @property {() => number} now  [ms] from any origin
 * @property {(action: () => void, ms: number) => any} setTimeout
 * @property {(timer: any) => void} clearTimeout
 *
 * @typedef {'closed' | 'connecting' | 'open' | 'waiting'} Phase
 * @typedef {{phase: Phase, code?: number, reason?: string, retryIn?: number}} Status
 */

/** @type {Timers} */
export const systemTimers = {
  now: () => performance.now(),
  setTimeout: (action, ms) => setTimeout(action, ms),
  clearTimeout: (timer) => clearTimeout(timer),
};

/**
 * A WebSocket that reconnects by itself.
 * @extends {Emitter<{text: string, binary: ArrayBuffer, open: void, status: Status}>}
 */
export class Connection extends Emitter {
  #url;
  #WebSocket;
  #timers;
  #random;
  #reconnect;
  /** @type {WebSocket | null} */
  #socket = null;
  /** @type {any} */
  #timer = null;
  #attempts = 0;
  /** @type {Phase} */
  phase = 'closed';

  /**
   * @param {string} url
   * @param {{WebSocket: any, timers: Timers, random: () => number, reconnect: boolean}} options
   */
  constructor(url, { WebSocket, timers, random, reconnect }) {
    super();
    this.#url = url;
    if (!WebSocket) throw new TypeError('no WebSocket here: pass { WebSocket } of the package ws');
    this.#WebSocket = WebSocket;
    this.#timers = timers;
    this.#random = random;
    this.#reconnect = reconnect;
  }

  open() {
    if (this.phase === 'connecting' || this.phase === 'open') return;
    this.#clearTimer();
    this.#enter({ phase: 'connecting' });
    const socket = new this.#WebSocket(this.#url, SUBPROTOCOL);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.#clearTimer();
      this.#enter({ phase: 'open' });
      this.emit('open', undefined);
    };
    socket.onmessage = (/** @type {{data: string | ArrayBuffer}} */ { data }) => {
      if (typeof data === 'string') this.emit('text', data);
      else this.emit('binary', data);
    };
    socket.onclose = (/** @type {{code: number, reason: string}} */ { code, reason }) =>
      this.#lost(code, reason);
    socket.onerror = () => this.#failed();
    this.#socket = socket;
    this.#timer = this.#timers.setTimeout(() => this.#lookAgain(), OPENING_LIMIT);
  }

  /** The time is up; but if this thread was busy, the socket may be open and its event be waiting. */
  #lookAgain() {
    this.#timer = this.#timers.setTimeout(() => this.drop(4002, 'no handshake'), SECOND_LOOK);
  }

  /** A close event that has the code follows, but in Node 20 none does where the handshake failed. */
  #failed() {
    if (this.phase !== 'connecting') return;
    this.#clearTimer();
    this.#timer = this.#timers.setTimeout(() => this.#lost(1006, 'no connection'), SECOND_LOOK);
  }

  /** Call when the server has proved healthy; the next loss is then retried soon. */
  settled() {
    this.#attempts = 0;
  }

  /** @param {string | Uint8Array} data */
  send(data) {
    // While the server's close is on its way, a browser complains of what is sent.
    const closes = (this.#socket?.readyState ?? OPEN) > OPEN;
    if (this.phase === 'open' && !closes) this.#socket?.send(data);
  }

  /** Closes for good. */
  close() {
    this.#clearTimer();
    if (this.phase === 'closed') return;
    this.#detach()?.close(NORMAL_CLOSE);
    this.#enter({ phase: 'closed', code: NORMAL_CLOSE, reason: 'closed by this side' });
  }

  /** Closes, and opens another address. @param {string} url */
  move(url) {
    this.close();
    this.#url = url;
    this.#attempts = 0;
    this.open();
  }

  /**
   * Abandons an unhealthy connection without waiting for the other side, and reconnects.
   * @param {number} code  4000 to 4999
   * @param {string} reason
   */
  drop(code, reason) {
    const socket = this.#detach();
    if (!socket) return;
    socket.close(code, reason);
    this.#lost(code, reason);
  }

  #detach() {
    const socket = this.#socket;
    this.#socket = null;
    if (!socket) return null;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.onerror = () => {}; // Node's package ws throws what has no listener
    return socket;
  }

  /**
   * @param {number} code
   * @param {string} reason
   */
  #lost(code, reason) {
    this.#detach();
    this.#clearTimer();
    if (!this.#reconnect || FINAL_CODES.has(code)) {
      this.#enter({ phase: 'closed', code, reason });
      return;
    }
    const pause = Math.min(LONGEST_PAUSE, FIRST_PAUSE * 2 ** this.#attempts);
    const retryIn = pause * (0.5 + 0.5 * this.#random());
    this.#attempts += 1;
    this.#timer = this.#timers.setTimeout(() => this.open(), retryIn);
    this.#enter({ phase: 'waiting', code, reason, retryIn });
  }

  #clearTimer() {
    if (this.#timer !== null) this.#timers.clearTimeout(this.#timer);
    this.#timer = null;
  }

  /** @param {Status} status */
  #enter(status) {
    this.phase = status.phase;
    this.emit('status', status);
  }
}

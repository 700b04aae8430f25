const RATE_PART = 0.95; // of the limit, in the long run
const BURST = 250; // in what time as many messages as fit may go at once [ms]
const USUAL_RATE = 1000; // messages a second, where the server names no limit

/**
 * Sends messages in their order and no faster than a limit allows: some at once after a quiet time,
 * then one after the other.
 */
export class Pace {
  #timers;
  /** @type {(() => void)[]} */
  #waiting = [];
  /** @type {any} */
  #timer = null;
  #interval = 1000 / (RATE_PART * USUAL_RATE); // between two in the long run [ms]
  #free = 0; // when all that was sent so far is worked off [ms]

  /** @param {import('./connection.js').Timers} timers */
  constructor(timers) {
    this.#timers = timers;
  }

  /** @param {number} [limit]  messages a second that the server allows, and as many at once */
  setLimit(limit = USUAL_RATE) {
    const before = this.#interval;
    this.#interval = 1000 / (RATE_PART * limit);
    const now = this.#timers.now(); // what was sent already counts by the new limit, too
    this.#free = now + (Math.max(0, this.#free - now) / before) * this.#interval;
  }

  /**
   * Calls it now if nothing waits and the limit allows, or else in its turn.
   * @param {() => void} send
   */
  push(send) {
    this.#waiting.push(send);
    if (this.#timer === null) this.#sendDue();
  }

  /** Forgets what waits. */
  clear() {
    this.#waiting = [];
    this.#timers.clearTimeout(this.#timer);
    this.#timer = null;
    this.#free = 0;
  }

  #sendDue() {
    this.#timer = null;
    while (this.#waiting.length) {
      const now = this.#timers.now();
      const begin = Math.max(this.#free, now);
      const wait = begin - Math.max(0, BURST - this.#interval) - now;
      if (wait > 0) {
        this.#timer = this.#timers.setTimeout(() => this.#sendDue(), wait);
        return;
      }
      this.#free = begin + this.#interval;
      this.#waiting.shift()?.();
    }
  }
}

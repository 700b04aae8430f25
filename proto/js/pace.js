const RATE_PART = 0.95; // of the limit, sustained
const BURST = 250; // a burst has the messages of this time [ms]
const USUAL_RATE = 1000; // messages a second, if the server names no limit

/**
 * Sends messages in order and no faster than a limit allows: a burst after a quiet time, then at
 * even intervals.
 */
export class Pace {
  #timers;
  /** @type {(() => void)[]} */
  #waiting = [];
  /** @type {any} */
  #timer = null;
  #interval = 1000 / (RATE_PART * USUAL_RATE); // sustained, between two messages [ms]
  #free = 0; // when all messages sent so far are paid off [ms]

  /** @param {import('./connection.js').Timers} timers */
  constructor(timers) {
    this.#timers = timers;
  }

  /** @param {number} [limit]  messages a second that the server allows, also as a burst */
  setLimit(limit = USUAL_RATE) {
    const before = this.#interval;
    this.#interval = 1000 / (RATE_PART * limit);
    const now = this.#timers.now(); // earlier messages count by the new limit too
    this.#free = now + (Math.max(0, this.#free - now) / before) * this.#interval;
  }

  /**
   * Calls it now if none waits and the limit allows, or else in its turn.
   * @param {() => void} send
   */
  push(send) {
    this.#waiting.push(send);
    if (this.#timer === null) this.#sendDue();
  }

  /** Drops the waiting messages. */
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

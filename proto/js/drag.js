const SHORTEST_INTERVAL = 1000 / 125; // between targets; faster motion is not visible [ms]
const REPEAT_INTERVAL = 400; // a target is repeated while the hand rests; the lease asks 500 [ms]

/**
 * A hand that holds the cloth. Made by `WeftClient.drag`; rapid targets are thinned out, the last
 * one is always sent, and it is repeated so that the lease does not end.
 */
export class Drag {
  #send;
  #timers;
  /** @type {number[] | undefined} */
  #target;
  /** A target waits to be sent. */
  #pending = false;
  /** @type {any} */
  #timer = null;
  #sentAt;
  /** @type {(reason: string) => void} */
  #resolveEnded = () => {};

  /**
   * @param {number} number  the viewer's own
   * @param {number[] | undefined} target  of the start
   * @param {(fields: object) => void} send
   * @param {import('./connection.js').Timers} timers
   */
  constructor(number, target, send, timers) {
    this.number = number;
    this.active = true;
    /** The room's number for it, once known. @type {number | null} */
    this.grab = null;
    /** Resolves with the reason when the hand lets go. @type {Promise<string>} */
    this.ended = new Promise((resolve) => (this.#resolveEnded = resolve));
    /** Result of the start; rejects if it was refused. @type {Promise<any>} */
    this.started = Promise.resolve();
    this.#send = send;
    this.#timers = timers;
    this.#target = target;
    this.#sentAt = timers.now();
    this.#schedule(REPEAT_INTERVAL);
  }

  /** @param {Promise<import('./messages.js').Answer<'drag'>>} started */
  begin(started) {
    this.started = started;
    started.then(
      ({ grab, target }) => {
        this.grab = grab;
        this.#target ??= target; // repeat the server's choice
      },
      (error) => this.finish(error.message),
    );
  }

  /** @param {number[]} target  target of the held point [m] */
  move(target) {
    if (!this.active) return;
    this.#target = [...target];
    const wait = this.#sentAt + SHORTEST_INTERVAL - this.#timers.now();
    if (wait <= 0) return this.#sendTarget();
    this.#pending = true;
    this.#schedule(wait);
  }

  /**
   * Lets go. A waiting target is sent first.
   * @param {{fire?: boolean}} [options]  fire: false lets go of a sling without its impulse
   */
  end(options = {}) {
    if (!this.active) return;
    if (this.#pending) this.#sendTarget();
    this.#send({ phase: 'end', drag: this.number, ...options });
    this.finish('end');
  }

  /**
   * Marks it as ended without telling the server, which already knows.
   * @param {string} reason
   */
  finish(reason) {
    if (!this.active) return;
    this.active = false;
    this.#timers.clearTimeout(this.#timer);
    this.#resolveEnded(reason);
  }

  #sendTarget() {
    if (this.#target) this.#send({ phase: 'move', drag: this.number, target: this.#target });
    this.#pending = false;
    this.#sentAt = this.#timers.now();
    this.#schedule(REPEAT_INTERVAL);
  }

  /** @param {number} wait [ms] */
  #schedule(wait) {
    this.#timers.clearTimeout(this.#timer);
    this.#timer = this.#timers.setTimeout(() => this.#sendTarget(), wait);
  }
}

const KEPT_PINGS = 8;
const KEPT_MARKS = 256;

/**
 * Round trip and clock offset from pings, as in NTP: the ping with the least round trip decides.
 */
export class ClockEstimate {
  /** @type {{roundTrip: number, offset: number}[]} */
  #samples = [];

  /**
   * @param {number} sent      own clock at departure of the ping [s]
   * @param {number} received  own clock at arrival of the answer [s]
   * @param {{received: number, sent: number}} server  its clock at the same events [s]
   */
  add(sent, received, server) {
    this.#samples.push({
      roundTrip: received - sent - (server.sent - server.received),
      offset: (server.received - sent + (server.sent - received)) / 2,
    });
    if (this.#samples.length > KEPT_PINGS) this.#samples.shift();
  }

  #best() {
    return this.#samples.reduce((best, s) => (s.roundTrip < best.roundTrip ? s : best));
  }

  /** Least of the last round trips [s]; NaN before the first. */
  get roundTrip() {
    return this.#samples.length ? this.#best().roundTrip : NaN;
  }

  /** Server's clock minus own clock [s]; NaN before the first ping. */
  get offset() {
    return this.#samples.length ? this.#best().offset : NaN;
  }
}

/** Time from sending a command to the frame that includes it. */
export class LatencyMeter {
  /** @type {{number: number, time: number}[]} */
  #marks = [];
  /** Of the newest command in the last frame that brought one [s]; NaN before the first. */
  latency = NaN;

  /**
   * @param {number} number  of the message on this connection
   * @param {number} time    [s]
   */
  sent(number, time) {
    this.#marks.push({ number, time });
    if (this.#marks.length > KEPT_MARKS) this.#marks.shift();
  }

  /**
   * @param {number} number  of the last message that a frame includes
   * @param {number} time    when the frame came [s]
   */
  applied(number, time) {
    let last;
    while (this.#marks.length && this.#marks[0].number <= number) last = this.#marks.shift();
    if (last) this.latency = time - last.time;
  }

  clear() {
    this.#marks = [];
  }
}

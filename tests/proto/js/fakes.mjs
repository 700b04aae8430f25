// A world without network and clock: sockets that the test plays the server of, and time that
// passes when the test says so.

export class FakeTimers {
  time = 0;
  #timers = new Map();
  #next = 1;

  now = () => this.time;
  setTimeout = (action, ms) => {
    this.#timers.set(this.#next, { action, at: this.time + ms });
    return this.#next++;
  };
  clearTimeout = (timer) => this.#timers.delete(timer);

  /** Lets time pass; what is due happens in order. */
  async pass(ms) {
    const end = this.time + ms;
    for (;;) {
      await settle();
      const due = [...this.#timers].filter(([, { at }]) => at <= end);
      if (!due.length) break;
      const [id, { action, at }] = due.reduce((a, b) => (b[1].at < a[1].at ? b : a));
      this.#timers.delete(id);
      this.time = Math.max(this.time, at);
      action();
    }
    this.time = end;
  }
}

/** Lets promises that are ready go on. */
export const settle = () => new Promise((resolve) => setImmediate(resolve));

/** A WebSocket class whose instances are kept in `sockets`. */
export function fakeSockets() {
  const sockets = [];
  class FakeSocket {
    constructor(url, protocol) {
      Object.assign(this, { url, protocol, sent: [], acks: [], closedWith: null });
      sockets.push(this);
    }
    send(data) {
      if (typeof data === 'string') this.sent.push(JSON.parse(data));
      else this.acks.push(data);
    }
    close(code, reason) {
      this.closedWith = { code, reason };
    }
    // The server's side:
    open() {
      this.onopen?.();
    }
    say(message) {
      this.onmessage?.({ data: typeof message === 'string' ? message : JSON.stringify(message) });
    }
    sayBytes(bytes) {
      this.onmessage?.({ data: bytes.slice().buffer });
    }
    lose(code, reason = '') {
      this.onclose?.({ code, reason });
    }
    /** What the client has sent with this op. */
    ops(op) {
      return this.sent.filter((message) => message.op === op);
    }
  }
  return { FakeSocket, sockets };
}

import { socketAddress, tokenOf } from './address.js';
import { decodeBinary, encodeAck, ProtocolError } from './codec.js';
import { Connection, SECOND_LOOK, systemTimers } from './connection.js';
import { Emitter } from './emitter.js';
import { CallTimeout, CommandError, ConnectionLost } from './errors.js';
import { requireFinite } from './finite.js';
import { FrameReader, KeyWish, LiveFrames } from './frames.js';
import { fetchMesh, matchMesh } from './mesh.js';
import { Pace } from './pace.js';
import { ClockEstimate, LatencyMeter } from './timing.js';
import { firstWelcome, LONGEST_TIMER } from './welcome.js';

/** @typedef {import('./mesh.js').Mesh} Mesh */

/**
 * @typedef {object} Options
 * @property {string} [name]
 * @property {string} [color]            `#rrggbb`
 * @property {string} [token]            for a server that asks for one; that of a link is read from there
 * @property {'socket' | 'http'} [mesh]  source of the mesh; over HTTP it is cached
 * @property {boolean} [reconnect]       default true
 * @property {import('./frames.js').FrameSource} [frames]  reads frames, in a worker perhaps
 * @property {number} [timeout]          for an answer [ms], default 30,000; Infinity: none
 * @property {any} [WebSocket]           the class; default that of the environment
 * @property {typeof fetch} [fetch]      for mesh: 'http'
 * @property {import('./connection.js').Timers} [timers]  for tests
 * @property {() => number} [random]     for tests
 *
 * @typedef {object} Call
 * @property {number} [timeout]  for the answer to this call [ms]; Infinity: none
 *
 * @typedef {object} Events
 * @property {import('./messages.js').Welcome} welcome  after each (re)connection
 * @property {Mesh} mesh
 * @property {import('./messages.js').Frame} frame      of the present mesh, decoded
 * @property {import('./messages.js').State} state
 * @property {import('./messages.js').Roster} roster
 * @property {import('./messages.js').PresenceNews} presence  of others and of this viewer
 * @property {import('./messages.js').Pins} pins
 * @property {import('./messages.js').Grabs} grabs
 * @property {import('./messages.js').Notice} notice
 * @property {import('./messages.js').Bye} bye
 * @property {import('./connection.js').Status} status  of the connection
 * @property {CommandError} refused  of a command sent by `post`
 * @property {Error} fault           an unreadable message; reconnects
 */

const PING_INTERVAL = 2000; // [ms]
const FIRST_PINGS = 5; // sent in quick succession, for a good clock from the start
const FIRST_PING_INTERVAL = 200; // [ms]
const CALL_TIMEOUT = 30000; // for an answer [ms]
const SILENCE_LIMIT = 10000; // silence after which the connection counts as dead [ms]
const FRAME = 1; // the type of a binary message
const KEY_VIEW = { codec: 'packed' }; // which makes the next frame a key
const EVENTS = new Set(['state', 'roster', 'presence', 'pins', 'grabs', 'notice', 'bye']);
const MEASURED = new Set(['drag', 'pin', 'release']); // commands with a visible effect

/**
 * The conversation with a server: requests and answers, events, the mesh, frames and their acks,
 * clock and latency. `WeftClient` adds the commands.
 * @extends {Emitter<Events>}
 */
export class Session extends Emitter {
  #url;
  #connection;
  /** @type {Map<number, {resolve: (value: any) => void, reject: (e: Error) => void, timer: any}>} */
  #waiting = new Map();
  /** Answers whose binary part has yet to arrive. @type {Map<number, (data: any) => void>} */
  #transfers = new Map();
  #nextId = 1;
  #sentMessages = 0;
  #pace;
  /** @type {import('./messages.js').MeshAnnouncement | null} */
  #announced = null;
  /** @type {any} */
  #pingTimer = null;
  #pings = 0;
  #heardAt = 0;
  #clock = new ClockEstimate();
  #meter = new LatencyMeter();
  #frames;
  #key;
  /** @type {import('./messages.js').Welcome | null} */
  welcome = null;
  /** @type {Mesh | null} */
  mesh = null;
  /** Arguments of `view` for each connection: those that were accepted, or as they are set here. @type {object} */
  wantedView = {};
  /**
   * @param {string} url  e.g. `ws://127.0.0.1:8080/ws`, or that of the page
   * @param {Options} [options]
   */
  constructor(url, options = {}) {
    super();
    this.options = { ...options };
    this.timers = options.timers ?? systemTimers;
    this.#frames = new LiveFrames(options.frames ?? new FrameReader());
    this.#pace = new Pace(this.timers);
    this.#key = new KeyWish(this.timers);
    this.#url = socketAddress(url, options.mesh);
    this.options.token ??= tokenOf(url);
    this.#connection = new Connection(this.#url.href, {
      WebSocket: options.WebSocket ?? globalThis.WebSocket,
      timers: this.timers,
      random: options.random ?? Math.random,
      reconnect: options.reconnect ?? true,
    });
    this.#connection.on('open', () => this.#opened());
    this.#connection.on('text', (text) => this.#guard(() => this.#readText(text)));
    this.#connection.on('binary', (bytes) => this.#guard(() => this.#readBinary(bytes)));
    this.#connection.on('status', (status) => this.#changed(status));
  }

  /**
   * Resolves with the first `welcome`. Rejects with `CallTimeout` if none comes in time, as where there is no such
   * room, and goes on trying until it is closed; without `reconnect` it rejects with `ConnectionLost` at once.
   * @param {Call} [call]
   * @returns {Promise<import('./messages.js').Welcome>}
   */
  connect({ timeout = this.options.timeout ?? CALL_TIMEOUT } = {}) {
    const welcome = firstWelcome(this, timeout);
    this.#connection.open();
    return welcome;
  }

  close() {
    this.#connection.close();
  }

  /** Leaves for another room or server, where it connects at once. @param {string} url @param {string} [token] */
  enter(url, token) {
    this.#url = socketAddress(url, this.options.mesh);
    this.options.token = token ?? tokenOf(url) ?? this.options.token;
    this.#connection.move(this.#url.href);
  }

  get connected() {
    return this.#connection.phase === 'open' && this.welcome !== null;
  }

  /** Own number among the viewers; 0 before `welcome`. */
  get viewer() {
    return this.welcome?.viewer ?? 0;
  }

  /** Least of the recent round trips [s]; NaN before the first. */
  get roundTrip() {
    return this.#clock.roundTrip;
  }

  /** Server's clock now [s], from pings; NaN before the first. */
  get serverTime() {
    return this.#now() + this.#clock.offset;
  }

  /** Age of the own hands' newest movement in the last frame that shows one [s]; or NaN. */
  get latency() {
    return this.#meter.latency;
  }

  /**
   * Sends a command and waits for its answer. It is sent as soon as the server's limit of messages
   * a second allows; rejects with `CallTimeout` if no answer arrives in time, and with `RangeError`
   * if a number is not finite, for which JSON has no word.
   * @template {string} Op
   * @param {Op} op
   * @param {object} [fields]
   * @param {Call} [call]
   * @returns {Promise<import('./messages.js').Answer<Op>>}
   */
  async request(op, fields = {}, { timeout = this.options.timeout ?? CALL_TIMEOUT } = {}) {
    requireFinite(fields, op);
    return this.#ask({ op, ...fields }, () => ({}), timeout);
  }

  /**
   * Sends a command without waiting for its answer. Without a connection it is dropped. Throws
   * `RangeError` if a number is not finite.
   * @param {string} op
   * @param {object} [fields]
   */
  post(op, fields = {}) {
    requireFinite(fields, op);
    if (this.connected) this.#send({ op, ...fields });
  }

  /**
   * Measures round trip and clock once; runs by itself every two seconds.
   * @param {Call} [call]
   */
  async ping({ timeout = this.options.timeout ?? CALL_TIMEOUT } = {}) {
    let t = NaN;
    const stamp = () => ({ t: (t = this.#now()) }); // at departure, not at the call
    const { received, sent } = await this.#ask({ op: 'ping' }, stamp, timeout);
    this.#clock.add(t, this.#now(), { received, sent });
    return this.#clock.roundTrip;
  }

  /**
   * @param {{op: string, [field: string]: unknown}} message
   * @param {() => object} last  fields that are filled in when it is sent
   * @param {number} timeout     [ms]
   * @returns {Promise<any>}
   */
  #ask({ op, ...fields }, last, timeout) {
    const id = this.#nextId++;
    return new Promise((resolve, reject) => {
      if (!this.connected) return reject(new ConnectionLost('not connected'));
      const expire = () => {
        this.#waiting.delete(id);
        reject(new CallTimeout(op, timeout));
      };
      const bounded = timeout <= LONGEST_TIMER; // an infinite one is not
      const timer = bounded ? this.timers.setTimeout(expire, timeout) : null;
      this.#waiting.set(id, { resolve, reject, timer });
      this.#send({ op, id, ...fields }, last);
    });
  }

  #now() {
    return this.timers.now() / 1000;
  }

  /**
   * @param {{op: string, [field: string]: unknown}} message
   * @param {() => object} [last]  fields that are filled in when it is sent
   */
  #send(message, last = () => ({})) {
    this.#pace.push(() => {
      this.#sentMessages += 1;
      if (MEASURED.has(message.op)) this.#meter.sent(this.#sentMessages, this.#now());
      this.#connection.send(JSON.stringify({ ...message, ...last() }));
    });
  }

  #opened() {
    this.#sentMessages = 0;
    this.#pace.clear();
    this.#meter.clear();
    this.#clock = new ClockEstimate();
    this.#pings = 0;
    this.#heardAt = this.timers.now();
    const { name, color, token } = this.options;
    if (name || color || token) this.#send({ op: 'hello', ...{ token, name, color } });
    if (Object.keys(this.wantedView).length) this.#send({ op: 'view', ...this.wantedView });
    this.#keepAlive();
  }

  /** @param {boolean} [again]  a second look at a silence: messages may wait behind a long task */
  #keepAlive(again = false) {
    const silent = this.timers.now() - this.#heardAt > SILENCE_LIMIT;
    if (silent && again) return this.#connection.drop(4002, 'the server is silent');
    if (this.connected) {
      this.#pings += 1;
      this.ping().catch(() => {}); // the status reports a lost connection
    }
    const wait = this.#pings < FIRST_PINGS ? FIRST_PING_INTERVAL : PING_INTERVAL;
    const next = silent ? SECOND_LOOK : wait;
    this.#pingTimer = this.timers.setTimeout(() => this.#keepAlive(silent), next);
  }

  /** @param {import('./connection.js').Status} status */
  #changed(status) {
    if (status.phase !== 'open') this.#forget(status.reason ?? status.phase);
    this.emit('status', status);
  }

  /** @param {string} reason */
  #forget(reason) {
    this.timers.clearTimeout(this.#pingTimer);
    this.welcome = null;
    this.#announced = null;
    this.#frames.drop();
    this.#key = new KeyWish(this.timers);
    this.#transfers.clear();
    this.#pace.clear();
    for (const id of [...this.#waiting.keys()]) this.#take(id)?.reject(new ConnectionLost(reason));
  }

  /**
   * Unreadable input ends this connection, because nothing after it can be trusted.
   * @param {() => void} read
   */
  #guard(read) {
    this.#heardAt = this.timers.now();
    try {
      read();
    } catch (error) {
      if (!(error instanceof ProtocolError)) throw error; // thrown by a listener
      this.#fail(error);
    }
  }

  /** @param {Error} error */
  #fail(error) {
    this.emit('fault', error);
    this.#connection.drop(4002, error.message.slice(0, 100));
  }

  /** @param {string} text */
  #readText(text) {
    let message;
    try {
      message = JSON.parse(text);
    } catch {
      throw new ProtocolError('a text message is not JSON');
    }
    if (message === null || typeof message !== 'object')
      throw new ProtocolError('a text message is no object');
    if (message.op === 'welcome') this.#welcomed(message);
    else if (message.op === 'mesh') this.#announce(message);
    else if (message.op === 'result') this.#answer(message);
    else if (message.op === 'error') this.#refuse(message);
    else if (EVENTS.has(message.op)) this.emit(message.op, message);
  }

  /** @param {import('./messages.js').Welcome} message */
  #welcomed(message) {
    this.#connection.settled();
    this.#pace.setLimit(message.limits?.messages_per_second);
    this.welcome = message;
    this.emit('welcome', message);
  }

  /** @param {import('./messages.js').MeshAnnouncement} announcement */
  #announce(announcement) {
    this.#announced = announcement;
    this.mesh = null;
    this.#frames.expectMesh();
    if (this.options.mesh !== 'http') return;
    const still = () => this.#announced === announcement;
    fetchMesh(this.#url, announcement, this.options.fetch).then(
      (data) => still() && this.#adoptMesh(data),
      (error) => still() && this.#fail(error),
    );
  }

  /** @param {import('./messages.js').MeshData} data */
  #adoptMesh(data) {
    this.mesh = matchMesh(this.#announced, data);
    this.#frames.begin(this.mesh.announcement.cloths, data);
    if (this.#key.resume()) this.post('view', KEY_VIEW);
    this.emit('mesh', this.mesh);
  }

  /** @param {any} message  a `result` */
  #answer(message) {
    const id = Number(message.id);
    if (!this.#waiting.has(id)) return;
    const settle = (/** @type {any} */ result) => this.#take(id)?.resolve(result);
    if (!message.binary) return settle(message);
    // It keeps waiting for the binary part; the connection may end before that arrives.
    this.#transfers.set(message.binary.transfer, (data) => settle({ ...message, data }));
  }

  /** @param {import('./messages.js').ErrorMessage} message */
  #refuse(message) {
    const error = new CommandError(message);
    const waiting = this.#take(Number(message.id));
    if (waiting) waiting.reject(error);
    else this.emit('refused', error);
  }

  /**
   * Takes the entry that waits for this answer out of the list.
   * @param {number} id
   */
  #take(id) {
    const waiting = this.#waiting.get(id);
    this.#waiting.delete(id);
    if (waiting) this.timers.clearTimeout(waiting.timer);
    return waiting;
  }

  /** @param {ArrayBuffer} bytes */
  #readBinary(bytes) {
    if (new Uint8Array(bytes)[0] === FRAME)
      return this.#frames.read(bytes, (got) => this.#guard(() => this.#receive(got)), (error) => this.#fail(error));
    const message = decodeBinary(bytes);
    if (message.type === 'mesh') return this.#adoptMesh(message);
    if (message.type === 'frame') throw new ProtocolError('a frame of another type');
    this.#transfers.get(message.transfer)?.(message);
    this.#transfers.delete(message.transfer);
  }

  /** @param {import('./frames.js').Received} received */
  #receive({ sequence, frame, early }) {
    if (!frame?.observed) this.#connection.send(encodeAck(sequence));
    if (early) return this.#key.defer();
    if (!frame) return this.#key.renew() && this.post('view', KEY_VIEW);
    this.#key.fulfil();
    const own = frame.applied.find(({ viewer }) => viewer === this.viewer);
    if (own) this.#meter.applied(own.number, this.#now());
    if (frame.epoch !== this.mesh?.announcement.epoch) return;
    if (frame.positions.length !== this.mesh.announcement.vertices * 3)
      throw new ProtocolError('the frame does not fit the mesh');
    this.emit('frame', frame);
  }
}

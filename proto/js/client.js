import { Drag } from './drag.js';
import { Session } from './session.js';

/** @typedef {import('./messages.js').Vec3} Vec3 */
/** @typedef {import('./messages.js').Hold} Hold */

/** @param {Hold} hold */
function holdFields(hold) {
  if ('triangle' in hold) return { triangle: hold.triangle, barycentric: hold.barycentric };
  return { particle: hold.particle };
}

/**
 * A viewer of a Weft server. Commands (proto/README.md section 5) return promises of their results;
 * they reject with `CommandError` if the server refuses and with `ConnectionLost` if the connection
 * ends first. Events are listed in session.js.
 */
export class WeftClient extends Session {
  /** @type {Map<number, Drag>} */
  #drags = new Map();
  #nextDrag = 1;

  /**
   * @param {string} url  e.g. `ws://127.0.0.1:8080/ws`, or that of the page
   * @param {import('./session.js').Options} [options]
   */
  constructor(url, options = {}) {
    super(url, options);
    this.on('status', ({ phase }) => {
      if (phase !== 'open') this.#finishDrags(() => true, 'connection lost');
    });
    this.on('refused', ({ code, value }) => {
      if (code === 'unknown_drag') this.#finishDrags((d) => d.number === value, 'lease expired');
    });
    this.on('grabs', ({ grabs }) => {
      const held = new Set(grabs.map(({ id }) => id));
      this.#finishDrags((d) => d.grab !== null && !held.has(d.grab), 'released by the server');
    });
  }

  /** @param {{name?: string, color?: string}} options  kept over reconnections */
  hello(options) {
    Object.assign(this.options, options);
    return this.request('hello', options);
  }

  /**
   * @param {Vec3} origin     [m]
   * @param {Vec3} direction
   * @returns {Promise<import('./messages.js').Hit | null>}
   */
  async pick(origin, direction) {
    return (await this.request('pick', { origin, direction })).hit;
  }

  /**
   * Takes the cloth in hand. Returns at once; `started` of what it returns tells how it went.
   * @param {Hold} hold  a hit of `pick` will do
   * @param {import('./messages.js').DragOptions} [options]
   */
  drag(hold, options = {}) {
    const number = this.#nextDrag++;
    const send = (/** @type {object} */ fields) => this.post('drag', fields);
    const drag = new Drag(number, options.target, send, this.timers);
    this.#drags.set(number, drag);
    drag.ended.then(() => this.#drags.delete(number));
    const start = { phase: 'start', drag: number, ...holdFields(hold), ...options };
    drag.begin(this.request('drag', start));
    return drag;
  }

  /**
   * @param {Hold} hold
   * @param {{radius?: number}} [options]
   */
  pin(hold, options = {}) {
    return this.request('pin', { ...holdFields(hold), ...options });
  }

  /** @param {{pin: number} | {particle: number} | {all: true}} which */
  release(which) {
    return this.request('release', which);
  }

  /**
   * Stores where this viewer looks from.
   * @param {Vec3} position
   * @param {Vec3} target
   * @param {{up?: Vec3, fov?: number}} [options]
   */
  camera(position, target, options = {}) {
    return this.request('camera', { position, target, ...options });
  }

  pause() {
    return this.request('pause');
  }

  resume() {
    return this.request('resume');
  }

  step(n = 1) {
    return this.request('step', { n });
  }

  reset() {
    return this.request('reset');
  }

  /** @param {number} speed */
  speed(speed) {
    return this.request('speed', { speed });
  }

  /**
   * Sends a collider to a pose at bounded speed, or gives it back to its keyframes; or sends a pin
   * to a place, at bounded speed or within some seconds, or stops it on its way.
   * @param {string | number} what  the collider's name, or the pin's id
   * @param {{position?: Vec3, rotation?: number[], speed?: number, turn_speed?: number,
   *   force?: boolean} | {release: true} |
   *   {position: Vec3, speed?: number, seconds?: number, max_force?: number} | {stop: true}} where
   */
  move(what, where) {
    const named = typeof what === 'number' ? { pin: what } : { collider: what };
    return this.request('move', { ...named, ...where });
  }

  /**
   * Opens, closes (opening 0) or moves a gripper; what is not told stays as it is.
   * @param {string} name
   * @param {{opening?: number, force?: number, position?: Vec3, rotation?: number[], speed?: number,
   *   turn_speed?: number}} wanted
   */
  gripper(name, wanted) {
    return this.request('gripper', { name, ...wanted });
  }

  /** @param {Partial<import('./messages.js').Settings>} values */
  set(values) {
    return this.request('set', values);
  }

  /** @param {number} n */
  advance(n) {
    return this.request('advance', { n });
  }

  hash() {
    return this.request('hash');
  }

  /** @param {string | object} scene  name, or a scene as the schema says */
  load(scene) {
    return this.request('load', { scene });
  }

  /** @param {{hz?: number, codec?: string, forces?: boolean}} options  kept over reconnections */
  view(options) {
    Object.assign(this.wantedView, options);
    return this.request('view', options);
  }

  /**
   * The data of a query; with a binary format `{tick, components, values}`.
   * @param {import('./messages.js').QueryWhat} what
   * @param {{format?: 'json' | 'f32' | 'f64', viewer?: number,
   *   tree?: string, level?: number}} [options]
   * @returns {Promise<any>}
   */
  async query(what, options = {}) {
    return (await this.request('query', { what, ...options })).data;
  }

  /**
   * @param {(drag: Drag) => boolean} which
   * @param {string} reason
   */
  #finishDrags(which, reason) {
    for (const drag of [...this.#drags.values()].filter(which)) drag.finish(reason);
  }
}

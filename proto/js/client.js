import { Drag } from './drag.js';
import { known } from './known.js';
import { Session } from './session.js';

/** @typedef {import('./messages.js').Vec3} Vec3 */
/** @typedef {import('./messages.js').Hold} Hold */
/** @typedef {import('./session.js').Call} Call */

const LOAD_TIMEOUT = 300_000; // [ms]
const ADVANCE_TIMEOUT = 60_000; // [ms]
const ADVANCE_TICK_TIMEOUT = 1000; // added for each tick [ms]

/** @param {Hold} hold */
function holdFields(hold) {
  if ('triangle' in hold) return { triangle: hold.triangle, barycentric: hold.barycentric };
  return { particle: hold.particle };
}

/**
 * A viewer of a Weft server. Commands (proto/README.md section 5) return promises of their results;
 * they reject with `CommandError` if the server refuses, with `ConnectionLost` if the connection ends
 * first, and with `CallTimeout` if no answer comes in time: `timeout` of the client's options, or of
 * the call, which is each command's last argument. `load` waits five minutes by default, `advance`
 * one, and a second more for each tick. Events are listed in session.js.
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

  /**
   * @param {{name?: string, color?: string}} options  kept over reconnections, once accepted
   * @param {Call} [call]
   */
  async hello(options, call) {
    const answer = await this.request('hello', known('hello', options), call);
    Object.assign(this.options, options);
    return answer;
  }

  /**
   * @param {Vec3} origin     [m]
   * @param {Vec3} direction
   * @param {Call} [call]
   * @returns {Promise<import('./messages.js').Hit | null>}
   */
  async pick(origin, direction, call) {
    return (await this.request('pick', { origin, direction }, call)).hit;
  }

  /**
   * Takes hold of the cloth. Returns at once; `started` of the result tells the outcome.
   * @param {Hold} hold  a hit of `pick` will do
   * @param {import('./messages.js').DragOptions} [options]
   * @param {Call} [call]  of its start
   */
  drag(hold, options = {}, call) {
    const number = this.#nextDrag++;
    known('drag', options);
    const send = (/** @type {object} */ fields) => this.post('drag', fields);
    const drag = new Drag(number, options.target, send, this.timers);
    this.#drags.set(number, drag);
    drag.ended.then(() => this.#drags.delete(number));
    const start = { phase: 'start', drag: number, ...holdFields(hold), ...options };
    drag.begin(this.request('drag', start, call));
    return drag;
  }

  /**
   * @param {Hold} hold
   * @param {{radius?: number}} [options]
   * @param {Call} [call]
   */
  pin(hold, options = {}, call) {
    return this.request('pin', { ...holdFields(hold), ...known('pin', options) }, call);
  }

  /**
   * @param {{pin: number} | {particle: number} | {all: true}} which
   * @param {Call} [call]
   */
  release(which, call) {
    return this.request('release', known('release', which), call);
  }

  /**
   * Stores this viewer's camera.
   * @param {Vec3} position
   * @param {Vec3} target
   * @param {{up?: Vec3, fov?: number}} [options]
   * @param {Call} [call]
   */
  camera(position, target, options = {}, call) {
    return this.request('camera', { position, target, ...known('camera', options) }, call);
  }

  /** @param {Call} [call] */
  pause(call) {
    return this.request('pause', {}, call);
  }

  /** @param {Call} [call] */
  resume(call) {
    return this.request('resume', {}, call);
  }

  /**
   * @param {number} [n]
   * @param {Call} [call]
   */
  step(n = 1, call) {
    return this.request('step', { n }, call);
  }

  /** @param {Call} [call] */
  reset(call) {
    return this.request('reset', {}, call);
  }

  /**
   * @param {number} speed
   * @param {Call} [call]
   */
  speed(speed, call) {
    return this.request('speed', { speed }, call);
  }

  /**
   * Sends a collider to a pose at bounded speed, or returns it to its keyframes; or sends a pin to
   * a place, at bounded speed or within some seconds, or stops it.
   * @param {string | number | {collider: number}} what  the collider's name, the pin's id, or the
   *   place of a collider in the list of `mesh`
   * @param {{position?: Vec3, rotation?: number[], speed?: number, turn_speed?: number,
   *   force?: boolean} | {release: true} |
   *   {position: Vec3, speed?: number, seconds?: number, max_force?: number} | {stop: true}} where
   * @param {Call} [call]
   */
  move(what, where, call) {
    const named =
      typeof what === 'object' ? what : typeof what === 'number' ? { pin: what } : { collider: what };
    return this.request('move', known('move', { ...named, ...where }), call);
  }

  /**
   * Opens, closes (opening 0) or moves a gripper; omitted values stay as they are.
   * @param {string} name
   * @param {{opening?: number, force?: number, position?: Vec3, rotation?: number[], speed?: number,
   *   turn_speed?: number}} wanted
   * @param {Call} [call]
   */
  gripper(name, wanted, call) {
    return this.request('gripper', { name, ...known('gripper', wanted) }, call);
  }

  /**
   * @param {import('./messages.js').SetCommand} values
   * @param {Call} [call]
   */
  set(values, call) {
    return this.request('set', known('set', values), call);
  }

  /**
   * Says who may hold the cloth.
   * @param {import('./commands.js').PolicyCommand['policy']} policy
   * @param {Call} [call]
   */
  policy(policy, call) {
    return this.request('policy', { policy }, call);
  }

  /**
   * Takes the right to hold from a viewer, whatever the policy.
   * @param {number} viewer
   * @param {{muted?: boolean}} [options]
   * @param {Call} [call]
   */
  mute(viewer, options = {}, call) {
    return this.request('mute', { viewer, ...known('mute', options) }, call);
  }

  /**
   * Gives a viewer the right to hold, whatever the policy.
   * @param {number} viewer
   * @param {{given?: boolean}} [options]
   * @param {Call} [call]
   */
  giveHand(viewer, options = {}, call) {
    return this.request('give_hand', { viewer, ...known('give_hand', options) }, call);
  }

  /**
   * Tells others where this viewer points and looks.
   * @param {import('./commands.js').PresenceCommand} where
   * @param {Call} [call]
   */
  presence(where, call) {
    return this.request('presence', known('presence', where), call);
  }

  /**
   * Sees by the camera of another viewer, whose `camera` comes with the event `presence`.
   * @param {number} viewer  0: by its own again
   * @param {Call} [call]
   */
  follow(viewer, call) {
    return this.request('follow', { viewer }, call);
  }

  /**
   * Brings all viewers to this one's camera.
   * @param {{on?: boolean}} [options]
   * @param {Call} [call]
   */
  lead(options = {}, call) {
    return this.request('lead', known('lead', options), call);
  }

  /**
   * Makes a token for a link; the result has it.
   * @param {import('./commands.js').InviteCommand['right']} right
   * @param {Call} [call]
   */
  invite(right, call) {
    return this.request('invite', { right }, call);
  }

  /**
   * @param {number} n
   * @param {Omit<import('./commands.js').AdvanceCommand, 'n'>} [options]  the frames that were asked for,
   *   that of the last tick without a word, come as events `frame` before the result; with `frames:
   *   undefined` they are those that the viewer's `hz` allows, some perhaps after it
   * @param {Call} [call]
   */
  advance(n, options = {}, call = { timeout: ADVANCE_TIMEOUT + ADVANCE_TICK_TIMEOUT * n }) {
    // What is observed is the last frame, and forces are then measured in no other tick.
    const frames = options.observe ? undefined : 'last';
    return this.request('advance', { n, frames, ...known('advance', options) }, call);
  }

  /** @param {Call} [call] */
  hash(call) {
    return this.request('hash', {}, call);
  }

  /**
   * @param {string | object} scene  name, or a scene that follows the schema
   * @param {Call} [call]
   */
  load(scene, call = { timeout: LOAD_TIMEOUT }) {
    return this.request('load', { scene }, call);
  }

  /**
   * Keeps the present state in memory, in place of an earlier one of this name.
   * @param {string} name
   * @param {Call} [call]
   */
  save(name, call) {
    return this.request('save', { name }, call);
  }

  /**
   * Back to a state that was saved.
   * @param {string} name
   * @param {Call} [call]
   */
  restore(name, call) {
    return this.request('restore', { name }, call);
  }

  /**
   * Opens a room beside this one; its address ends in `/ws/name`.
   * @param {string} name
   * @param {{scene?: string, paused?: boolean}} [options]
   * @param {Call} [call]
   */
  createRoom(name, options = {}, call = { timeout: LOAD_TIMEOUT }) {
    return this.request('create_room', { name, ...known('create_room', options) }, call);
  }

  /**
   * Opens a room that is like this one at this moment; its address ends in `/ws/name`.
   * @param {string} name
   * @param {{paused?: boolean}} [options]
   * @param {Call} [call]
   */
  fork(name, options = {}, call = { timeout: LOAD_TIMEOUT }) {
    return this.request('fork', { name, ...known('fork', options) }, call);
  }

  /** @param {Call} [call] */
  listRooms(call) {
    return this.request('list_rooms', {}, call);
  }

  /**
   * Closes a room and the connections of its viewers; the default one stays.
   * @param {string} name
   * @param {Call} [call]
   */
  closeRoom(name, call) {
    return this.request('close_room', { name }, call);
  }

  /**
   * @param {{hz?: number, codec?: 'f32' | 'packed', error?: number, forces?: boolean}} options  kept over
   *   reconnections, once accepted
   * @param {Call} [call]
   */
  async view(options, call) {
    const answer = await this.request('view', known('view', options), call);
    Object.assign(this.wantedView, options);
    return answer;
  }

  /**
   * The data of a query; with a binary format `{tick, components, values}`.
   * @template {import('./messages.js').QueryWhat} What
   * @template {import('./messages.js').QueryOptions} [Options={}]
   * @param {What} what
   * @param {Options} [options]
   * @param {Call} [call]
   * @returns {Promise<import('./messages.js').QueryAnswer<What, Options>>}
   */
  async query(what, options, call) {
    return (await this.request('query', { what, ...known('query', options ?? {}) }, call)).data;
  }

  /**
   * @param {(drag: Drag) => boolean} which
   * @param {string} reason
   */
  #finishDrags(which, reason) {
    for (const drag of [...this.#drags.values()].filter(which)) drag.finish(reason);
  }
}

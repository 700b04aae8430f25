import type { Frame, GrabSample, PoseSample } from '../../../proto/js/messages.js';
import { HoldingPace } from './holding_pace.js';

const LONGEST_DELAY = 0.25; // [s]
const LONGEST_CATCH_UP = 1; // that a holder's picture makes up for instead of jumping [s]
const KEPT_FRAMES = 24;
const OFFSET_LEAK = 0.0005; // an early packet is forgotten within minutes, not seconds

/**
 * Decides which moment is shown: one of the recent past, interpolated between two frames, so that
 * uneven arrival does not show. With a hand in the cloth that is as near to the newest frame as
 * even motion allows. It never extrapolates and never goes back: when ticks stop, nothing moves.
 */
export class Playback {
  /** Three values a vertex [m]. */
  positions: Float32Array;
  grabs: GrabSample[] = [];
  /** Objects whose poses differ from the mesh. */
  poses: PoseSample[] = [];
  tick = -1;
  private frames: Frame[] = [];
  private shown_time = -Infinity; // on the server's clock [s]
  private last_sample = 0; // client's clock [s]
  private offset = Infinity; // client's clock minus the server's at arrival, without delays [s]
  private interval = 1 / 60; // between frames [s]
  private jitter = 0; // by which frames arrive late [s]
  private pace = new HoldingPace();
  private held = false; // by this viewer
  private renewed = false; // the newest frame's moment was shown before as it was then

  constructor(vertices: number) {
    this.positions = new Float32Array(vertices * 3);
  }

  /** @param now client's clock [s] */
  push(frame: Frame, now: number): void {
    const last = this.frames.at(-1);
    if (frame.jump || (last && frame.serverTime < last.serverTime)) this.forget();
    else if (last?.serverTime === frame.serverTime) return this.renew(frame);
    else if (last) this.measure(frame, last, now);
    this.offset = Math.min(this.offset, now - frame.serverTime);
    this.frames.push(frame);
    if (this.frames.length > KEPT_FRAMES) this.frames.shift();
  }

  /** Restarts with the next frame, as after a pause in receiving. */
  forget(): void {
    this.frames = [];
    this.shown_time = -Infinity;
    this.offset = Infinity;
    this.pace.restart();
  }

  /** The moment that is shown, on the server's clock [s]. */
  get time(): number {
    return this.shown_time;
  }

  /**
   * Updates positions and grabs to the moment to show, with hands that come after it; tells whether they changed.
   * @param now   client's clock [s]
   * @param holds whether this viewer has a hand in the cloth
   */
  sample(now: number, holds: boolean): boolean {
    const newest = this.frames.at(-1);
    if (!newest) return false;
    const elapsed = Math.min(0.1, Math.max(0, now - this.last_sample));
    this.last_sample = now;
    if (holds && !this.held) this.pace.take_hold();
    this.held = holds;
    const before = this.shown_time;
    const behind = newest.serverTime - before;
    if (Number.isFinite(behind)) this.pace.look(elapsed, now - this.offset - newest.serverTime, behind);
    const follow = () =>
      holds && behind < LONGEST_CATCH_UP
        ? before + this.pace.step(elapsed, behind)
        : this.follow(now, elapsed, newest);
    this.shown_time = Math.max(before, newest.paused ? newest.serverTime : follow());
    if (this.shown_time === before && !this.renewed) return false;
    this.renewed = false;
    this.show();
    this.add_new_hands();
    return true;
  }

  /** Between two ticks hands move and objects are placed: the same moment looks different. */
  private renew(frame: Frame): void {
    this.frames[this.frames.length - 1] = frame;
    this.renewed = true;
  }

  private measure(frame: Frame, last: Frame, now: number): void {
    const interval = frame.serverTime - last.serverTime;
    if (interval < 0.5) {
      this.interval += (interval - this.interval) * 0.05;
      this.pace.arrived(now - last.serverTime - this.offset, interval);
    }
    const late = now - frame.serverTime - this.offset;
    this.jitter = Math.max(late, this.jitter * 0.99);
    this.offset += late * OFFSET_LEAK;
  }

  /** Approaches the wanted delay at nearly natural speed, so that changes of delay do not show. */
  private follow(now: number, elapsed: number, newest: Frame): number {
    const delay = Math.min(LONGEST_DELAY, 1.2 * this.interval + this.jitter);
    const wanted = now - this.offset - delay;
    const behind = wanted - (this.shown_time + elapsed);
    if (!Number.isFinite(behind) || behind > LONGEST_DELAY) {
      return Math.min(Math.max(wanted, this.frames[0].serverTime), newest.serverTime);
    }
    const rate = 1 + Math.min(0.15, Math.max(-0.15, 2 * behind));
    return Math.min(this.shown_time + elapsed * rate, newest.serverTime);
  }

  /** A hand is seen as soon as it is told of: it waits where it begins until the picture has come to that moment. */
  private add_new_hands(): void {
    const grabs = new Map(this.grabs.map((grab) => [grab.id, grab]));
    for (const frame of this.frames) for (const grab of frame.grabs) if (!grabs.has(grab.id)) grabs.set(grab.id, grab);
    if (grabs.size > this.grabs.length) this.grabs = [...grabs.values()];
  }

  private show(): void {
    while (this.frames.length > 1 && this.frames[1].serverTime <= this.shown_time) {
      this.frames.shift();
    }
    const [from, to] = this.frames;
    this.tick = from.tick;
    if (!to || this.shown_time <= from.serverTime) {
      this.positions.set(from.positions);
      this.grabs = from.grabs;
      this.poses = from.poses;
      return;
    }
    const part = (this.shown_time - from.serverTime) / (to.serverTime - from.serverTime);
    const a = from.positions;
    const b = to.positions;
    for (let i = 0; i < a.length; i++) this.positions[i] = a[i] + (b[i] - a[i]) * part;
    this.grabs = from.grabs.map((grab) => between(grab, to.grabs, part));
    this.poses = from.poses.map((pose) => pose_between(pose, to.poses, part));
  }
}

/** Takes the shorter rotation; for so small a turn the interpolation is even enough. */
function pose_between(pose: PoseSample, later: PoseSample[], part: number): PoseSample {
  const next = later.find(({ collider }) => collider === pose.collider);
  if (!next) return pose;
  const mix = (a: number[], b: number[], sign: number) =>
    a.map((value, i) => value * (1 - part) + sign * b[i] * part);
  const along = pose.rotation.reduce((sum, value, i) => sum + value * next.rotation[i], 0);
  const rotation = mix(pose.rotation, next.rotation, along < 0 ? -1 : 1);
  const norm = Math.hypot(...rotation);
  return {
    collider: pose.collider,
    position: mix(pose.position, next.position, 1),
    rotation: rotation.map((value) => value / norm),
  };
}

function between(grab: GrabSample, later: GrabSample[], part: number): GrabSample {
  const next = later.find(({ id }) => id === grab.id);
  if (!next) return grab;
  const target = grab.target.map((value, i) => value + (next.target[i] - value) * part);
  return { ...grab, target };
}

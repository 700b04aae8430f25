const KEPT_ARRIVALS = 120;
const FROZEN_PART = 0.05; // of the time, in which the next frame may be missing
const MOST_BEHIND = 0.0125; // the newest frame, at ordinary rates of ticks [s]
const MOST_INTERVALS_BEHIND = 0.85; // the same for slow ticks, in intervals between frames
const MEASURED_TIME = 0.2; // over which the distance to the newest frame is averaged [s]
const AGE_TIME = 1; // over which the newest frame's age is averaged [s]
const CORRECTION = 4; // of the speed by a second too far behind [1/s]
const MOST_CORRECTION = 0.25;
const HURRY_CORRECTION = 20; // the same when a hand has just taken hold [1/s]
const MOST_HURRY_CORRECTION = 1;
const BRAKING_TIME = 0.008; // in which the picture halts before the newest frame [s]
const NEAR_ENOUGH = 1e-4; // to the newest frame to be called there [s]

/** By how much a frame came later than its predecessor alone could be shown, and their distance. */
interface Arrival {
  delay: number;
  interval: number;
}

/**
 * The pace of the picture of a viewer that holds the cloth. It stays behind the newest frame by as
 * little as keeps the motion even: about half a tick and what arrivals vary by, and never by more
 * than a hand notices. Before the newest frame it brakes instead of stopping dead.
 */
export class HoldingPace {
  private arrivals: Arrival[] = [];
  private delay = 0; // after the earliest possible arrival, that would do [s]
  private interval = 1 / 60; // between frames [s]
  private behind: number | null = null; // mean distance to the newest frame [s]
  private age = 0; // mean of the newest frame since its earliest possible arrival [s]
  private hurries = false; // until the picture is at its place behind the newest frame

  /**
   * @param delay    from the earliest possible arrival of the frame before to this one's arrival [s]
   * @param interval between the two frames [s]
   */
  arrived(delay: number, interval: number): void {
    this.arrivals.push({ delay, interval });
    if (this.arrivals.length > KEPT_ARRIVALS) this.arrivals.shift();
    const total = this.arrivals.reduce((sum, arrival) => sum + arrival.interval, 0);
    this.interval = total / this.arrivals.length;
    const delays = this.arrivals.map((arrival) => arrival.delay);
    this.delay = delay_with_excess(delays, FROZEN_PART * total);
  }

  /** Starts anew behind the next frame. */
  restart(): void {
    this.behind = null;
  }

  /** A hand takes hold: what it does is to be seen soon, so the picture hurries to its place. */
  take_hold(): void {
    this.hurries = true;
  }

  /** Looks at a picture before it goes on. @param age of the newest frame [s] */
  look(elapsed: number, age: number, behind: number): void {
    const part = (time: number) => 1 - Math.exp(-elapsed / time);
    this.age += (age - this.age) * part(AGE_TIME);
    this.behind = (this.behind ?? behind) + (behind - (this.behind ?? behind)) * part(MEASURED_TIME);
  }

  /** How far behind the newest frame the picture should be on average [s]. */
  get wanted(): number {
    const most = Math.max(MOST_BEHIND, MOST_INTERVALS_BEHIND * this.interval);
    return Math.min(most, Math.max(0, this.delay - this.age));
  }

  /** By how much the picture goes on in some time [s]. @param behind the newest frame now [s] */
  step(elapsed: number, behind: number): number {
    if (behind < NEAR_ENOUGH) return behind;
    if (this.hurries && this.lateness(behind) <= 0) {
      this.hurries = false;
      this.behind = this.wanted;
    }
    return Math.min(elapsed * this.speed(behind), behind * (1 - Math.exp(-elapsed / BRAKING_TIME)));
  }

  /** By how much the picture is farther behind than its place at this moment of a tick may be [s]. */
  private lateness(behind: number): number {
    return behind - this.wanted - this.interval / 2;
  }

  /** Of the picture, as a factor of the natural speed. */
  private speed(behind: number): number {
    if (this.hurries) return 1 + Math.min(MOST_HURRY_CORRECTION, HURRY_CORRECTION * this.lateness(behind));
    const excess = CORRECTION * ((this.behind ?? behind) - this.wanted);
    return 1 + Math.min(MOST_CORRECTION, Math.max(-MOST_CORRECTION, excess));
  }
}

/** The least delay beyond which some delays reach by no more than `excess` in all [s]. */
function delay_with_excess(delays: number[], excess: number): number {
  const falling = [...delays].sort((a, b) => b - a);
  let sum = 0;
  for (let n = 1; n < falling.length; n++) {
    const more = (falling[n - 1] - falling[n]) * n;
    if (sum + more > excess) return falling[n - 1] - (excess - sum) / n;
    sum += more;
  }
  return falling.at(-1) ?? 0;
}

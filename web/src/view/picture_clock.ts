import { Rest } from './rest.js';

const LONGEST_STEP = 0.1; // that the camera goes on at once after the page stood still [s]

/** Times of the display's pictures, of which those are drawn that differ from the last one. */
export class PictureClock {
  private now = performance.now() / 1000;
  private interval = 0; // since the display's last picture [s]
  private drew = false; // for the display's last picture
  private rest = new Rest();

  /** Begins the display's next picture; returns the time by which the camera goes on [s]. @param now [s] */
  step(now: number): number {
    this.interval = now - this.now;
    this.now = now;
    return Math.min(LONGEST_STEP, this.interval);
  }

  /**
   * @param changed whether this picture is drawn, as it differs from the last one
   * @param ticking whether it differs by a tick of a room that goes on, and not by the viewer's doing
   * @returns whether the picture rests, and the time between two that are drawn in a row [s]
   */
  judge(changed: boolean, ticking: boolean): { still: boolean; interval: number | null } {
    const interval = changed && this.drew ? this.interval : null;
    this.drew = changed;
    return { still: this.rest.update(this.now, changed, ticking), interval };
  }
}

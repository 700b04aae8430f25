const SHORTEST_WAIT = 0.4; // without change, before the finest picture is drawn [s]
const LONGEST_WAIT = 10; // [s]
const PATIENCE = 4; // by which the wait grows when a rest was cut short
const LONG_REST = 4; // a rest of this time was worth its picture [s]

/**
 * Decides when the picture rests and may be drawn as finely as it can be. Where ticks are far apart
 * a rest between two of them ends at once, and the canvas would change its size at each of them; so
 * a rest that a tick cuts short makes the wait for the next one longer.
 */
export class Rest {
  private wait = SHORTEST_WAIT;
  private changed_at = 0;
  private began_at: number | null = null;

  /**
   * @param now     [s]
   * @param changed whether the picture is about to change
   * @param ticking whether it changes by a tick of a room that goes on, and not by the viewer's doing
   * @returns whether the picture rests
   */
  update(now: number, changed: boolean, ticking: boolean): boolean {
    if (changed) {
      if (this.began_at !== null && ticking) this.cut_short(now - this.began_at);
      this.began_at = null;
      this.changed_at = now;
    } else if (now - this.changed_at > this.wait) {
      this.began_at ??= now;
    }
    return this.began_at !== null;
  }

  /** @param rest that has ended [s] */
  private cut_short(rest: number): void {
    this.wait = rest >= LONG_REST ? SHORTEST_WAIT : Math.min(LONGEST_WAIT, PATIENCE * this.wait);
  }
}

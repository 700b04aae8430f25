/** A frame that shows a movement of the own hand and is not on the screen yet. */
interface Coming {
  time: number; // of the frame, on the server's clock [s]
  moved: number; // when the hand moved [s]
}

/**
 * Time from a movement of the own hand to the picture that shows it, while a hand holds the cloth
 * in a running room. What the hand did before that would measure the pause. Times are of the
 * client's clock [s] unless they say otherwise.
 */
export class HandLatency {
  private since: number | null = null; // when the cloth was held and the room ran
  private coming: Coming[] = [];
  private last_latency = NaN;

  /**
   * @param measurable whether a hand holds the cloth in a running room
   * @returns whether that changed
   */
  watch(measurable: boolean, now: number): boolean {
    if (measurable === (this.since !== null)) return false;
    this.since = measurable ? now : null;
    this.coming = [];
    return true;
  }

  /**
   * @param time    of a frame, on the server's clock [s]
   * @param latency from the newest movement that the frame shows to its arrival [s]; NaN: none
   */
  received(time: number, latency: number, now: number): void {
    const moved = now - latency;
    const fresh = latency !== this.last_latency; // else the frame shows no new movement
    this.last_latency = latency;
    if (this.since !== null && fresh && moved >= this.since) this.coming.push({ time, moved });
  }

  /**
   * The latency of the newest movement that a picture shows first [s]; null if it shows no new one.
   * @param time that the picture shows, on the server's clock [s]
   */
  shown(time: number, now: number): number | null {
    let newest: Coming | undefined;
    while (this.coming.length && this.coming[0].time <= time) newest = this.coming.shift();
    return newest ? now - newest.moved : null;
  }
}

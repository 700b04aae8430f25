export const LONG_PRESS = 550; // [ms]
const FINGER_WANDER = 10; // tolerated movement of a resting finger [pixels]

/**
 * A pressed mouse button or finger, and what it does: `hand` holds something, `depth` pushes what
 * other fingers hold, `camera` moves the view, `none` does nothing until its release.
 */
export class Pointer {
  readonly id: number;
  readonly touch: boolean;
  role: 'hand' | 'depth' | 'camera' | 'none' = 'none';
  /** A camera that is shifted rather than turned. */
  pans = false;
  /** Farther than a resting finger wanders. */
  moved = false;
  x: number; // [pixels of the window]
  y: number;
  private start: { x: number; y: number };
  private timer = 0;

  constructor({ pointerId, pointerType, clientX, clientY }: PointerEvent) {
    this.id = pointerId;
    this.touch = pointerType === 'touch';
    [this.x, this.y] = [clientX, clientY];
    this.start = { x: clientX, y: clientY };
  }

  move({ clientX, clientY }: PointerEvent): void {
    [this.x, this.y] = [clientX, clientY];
    if (Math.hypot(clientX - this.start.x, clientY - this.start.y) <= FINGER_WANDER) return;
    this.moved = true;
    this.stop_waiting();
  }

  await_long_press(act: () => void): void {
    this.timer = window.setTimeout(() => {
      // On a busy page the finger may have moved without an event yet; such events arrive before
      // the next picture.
      const { timer } = this;
      requestAnimationFrame(() => timer === this.timer && act());
    }, LONG_PRESS);
  }

  stop_waiting(): void {
    window.clearTimeout(this.timer);
    this.timer = 0;
  }
}

import { Vector2 } from 'three';

export const LONG_PRESS = 550; // [ms]
const FINGER_WANDER = 10; // tolerated movement of a resting finger [pixels]
const ORBIT_SPEED = 0.0052; // [rad per pixel]
const ZOOM_SPEED = 0.0011; // [1 per pixel of the wheel]
const DEPTH_SPEED = 0.0005;
const LINE_HEIGHT = 16; // for wheels that count lines [pixels]

/** Actions of mouse, touch and wheel. Points are in normalised device coordinates. */
export interface Actions {
  /** Takes hold of the cloth if it is at the point. */
  take(point: Vector2): boolean;
  /** Takes hold of the object at the point. */
  take_object(point: Vector2): boolean;
  follow(point: Vector2): void;
  push(factor: number): void;
  /** @param meant the pointer was released, rather than the hold interrupted */
  let_go(meant: boolean): void;
  toggle_pin(point: Vector2): void;
  orbit(azimuth: number, elevation: number): void;
  pan(dx: number, dy: number): void;
  zoom(factor: number): void;
  changed(): void;
}

export type InputState = 'idle' | 'camera' | 'holding';

interface Finger {
  id: number;
  x: number;
  y: number;
}

/**
 * One state machine for mouse and touch. When idle, it hovers; what lies under the pressed pointer
 * decides whether it moves the camera or holds the cloth until its release.
 */
export class Input {
  state: InputState = 'idle';
  /** Where the mouse hovers or the hand holds; null outside the view. */
  point: Vector2 | null = null;
  private fingers: Finger[] = []; // pressed ones, in order
  private panning = false;
  private press_timer = 0;
  private press_start = { x: 0, y: 0 };

  constructor(
    private view: HTMLElement,
    private actions: Actions,
  ) {
    const listen = <Name extends keyof HTMLElementEventMap>(
      name: Name,
      handle: (event: HTMLElementEventMap[Name]) => void,
    ) => view.addEventListener(name, handle, { passive: false });
    listen('pointerdown', (event) => this.down(event));
    listen('pointermove', (event) => this.move(event));
    listen('pointerup', (event) => this.up(event));
    listen('pointercancel', () => this.cancel());
    listen('lostpointercapture', (event) => this.up(event));
    listen('pointerleave', () => this.leave());
    listen('contextmenu', (event) => event.preventDefault());
    listen('wheel', (event) => this.wheel(event));
    window.addEventListener('blur', () => this.cancel());
    document.addEventListener('visibilitychange', () => document.hidden && this.cancel());
  }

  /** Lets go of everything. */
  cancel(): void {
    this.fingers = [];
    this.enter('idle');
  }

  private down(event: PointerEvent): void {
    event.preventDefault();
    this.view.focus({ preventScroll: true });
    const touch = event.pointerType === 'touch';
    if (!touch && this.fingers.length > 0) return; // further buttons are ignored
    this.view.setPointerCapture(event.pointerId);
    this.fingers.push({ id: event.pointerId, x: event.clientX, y: event.clientY });
    this.point = this.locate(event);
    if (this.fingers.length > 1) {
      this.enter('camera');
      return;
    }
    const object = event.shiftKey && event.ctrlKey;
    this.panning = !touch && !object && (event.button !== 0 || event.shiftKey);
    const take = () =>
      object ? this.actions.take_object(this.point!) : this.actions.take(this.point!);
    const holds = !this.panning && take();
    this.enter(holds ? 'holding' : 'camera');
    if (holds && touch) this.await_long_press(event);
  }

  private move(event: PointerEvent): void {
    if (this.fingers.length === 0) {
      if (event.pointerType !== 'touch') this.point = this.locate(event);
      this.actions.changed();
      return;
    }
    const finger = this.fingers.find(({ id }) => id === event.pointerId);
    if (!finger) return;
    const before = this.fingers.map(({ x, y }) => ({ x, y }));
    const wander = Math.hypot(
      event.clientX - this.press_start.x,
      event.clientY - this.press_start.y,
    );
    if (wander > FINGER_WANDER) this.stop_waiting();
    finger.x = event.clientX;
    finger.y = event.clientY;
    if (this.state === 'camera') this.move_camera(before);
    else if (this.state === 'holding') {
      this.point = this.locate(event);
      this.actions.follow(this.point);
    }
  }

  private up(event: PointerEvent): void {
    const place = this.fingers.findIndex(({ id }) => id === event.pointerId);
    if (place < 0) return;
    this.fingers.splice(place, 1);
    if (event.pointerType === 'touch') this.point = null;
    if (this.fingers.length === 0) this.enter('idle', true);
  }

  private leave(): void {
    if (this.fingers.length > 0) return;
    this.point = null;
    this.actions.changed();
  }

  private move_camera(before: { x: number; y: number }[]): void {
    const [a, b] = this.fingers;
    const height = this.view.clientHeight;
    if (!b) {
      const [dx, dy] = [a.x - before[0].x, a.y - before[0].y];
      if (this.panning) this.actions.pan(dx / height, -dy / height);
      else this.actions.orbit(-dx * ORBIT_SPEED, dy * ORBIT_SPEED);
      return;
    }
    const middle = (p: { x: number; y: number }, q: { x: number; y: number }) =>
      new Vector2((p.x + q.x) / 2, (p.y + q.y) / 2);
    const shift = middle(a, b).sub(middle(before[0], before[1]));
    this.actions.pan(shift.x / height, -shift.y / height);
    const spread = Math.hypot(a.x - b.x, a.y - b.y);
    const spread_before = Math.hypot(before[0].x - before[1].x, before[0].y - before[1].y);
    if (spread > 1 && spread_before > 1) this.actions.zoom(spread_before / spread);
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const unit = [1, LINE_HEIGHT, this.view.clientHeight][event.deltaMode] ?? 1;
    const amount = Math.min(400, Math.max(-400, event.deltaY * unit));
    // A trackpad's pinch arrives as a wheel with Ctrl, in smaller numbers.
    const speed = event.ctrlKey ? 8 : 1;
    if (this.state === 'holding') this.actions.push(Math.exp(-amount * speed * DEPTH_SPEED));
    else this.actions.zoom(Math.exp(amount * speed * ZOOM_SPEED));
  }

  private await_long_press(event: PointerEvent): void {
    this.press_start = { x: event.clientX, y: event.clientY };
    const point = this.locate(event);
    this.press_timer = window.setTimeout(() => {
      // On a busy page the finger may have moved without an event yet; such events arrive before
      // the next picture.
      const timer = this.press_timer;
      requestAnimationFrame(() => {
        if (timer !== this.press_timer) return;
        this.enter('idle'); // until it is lifted, the finger does nothing
        this.actions.toggle_pin(point);
      });
    }, LONG_PRESS);
  }

  private stop_waiting(): void {
    window.clearTimeout(this.press_timer);
    this.press_timer = 0;
  }

  private enter(state: InputState, meant = false): void {
    this.stop_waiting();
    if (this.state === 'holding' && state !== 'holding') this.actions.let_go(meant);
    this.state = state;
    this.actions.changed();
  }

  private locate(event: PointerEvent): Vector2 {
    const { left, top, width, height } = this.view.getBoundingClientRect();
    const x = ((event.clientX - left) / width) * 2 - 1;
    return new Vector2(x, 1 - ((event.clientY - top) / height) * 2);
  }
}

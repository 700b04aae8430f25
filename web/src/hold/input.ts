import { Vector2 } from 'three';
import { Pointer } from './pointer.js';

const ORBIT_SPEED = 0.0052; // [rad per pixel]
const ZOOM_SPEED = 0.0011; // [1 per pixel of the wheel]
const DEPTH_SPEED = 0.0005; // [1 per pixel of the wheel]
const FINGER_DEPTH = 1.5; // logarithm of the factor by a finger that moves by the view's height
const LINE_HEIGHT = 16; // for wheels that count lines [pixels]
const TAP_TIME = 350; // from a tap to the finger's return, to shift the view [ms]
const TAP_WANDER = 40; // between the two [pixels]

/** Actions of mouse, touch and wheel. Points are in normalised device coordinates. */
export interface Actions {
  /** Takes hold of what is at the point. @param hand number of the pointer */
  take(hand: number, point: Vector2): boolean;
  /** Takes hold of the object at the point. */
  take_object(hand: number, point: Vector2): boolean;
  follow(hand: number, point: Vector2): void;
  /** Moves all that is held away from the eye. @param factor of the distance */
  push(factor: number): void;
  /** @param meant the pointer was released, rather than the hold interrupted */
  let_go(hand: number, meant: boolean): void;
  /** Whether a long press at the point does anything. */
  pressable(hand: number, point: Vector2): boolean;
  press(point: Vector2): void;
  orbit(azimuth: number, elevation: number): void;
  pan(dx: number, dy: number): void;
  zoom(factor: number): void;
  changed(): void;
}

export type InputState = 'idle' | 'camera' | 'holding';

/**
 * The state machine of mouse and touch. What lies under a pressed pointer decides what it does
 * until its release: it is a hand, or it moves the camera, or, beside a hand, it pushes the hand
 * away and draws it near. So each finger on the cloth is a hand of its own.
 */
export class Input {
  /** Where the mouse is; null outside the view. */
  point: Vector2 | null = null;
  private pointers: Pointer[] = []; // pressed ones, in order
  private last_tap = { time: -Infinity, x: 0, y: 0 };

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
    listen('pointerup', (event) => this.up(event, true));
    listen('pointercancel', (event) => this.up(event, false));
    listen('lostpointercapture', (event) => this.up(event, true));
    listen('pointerleave', () => this.leave());
    listen('contextmenu', (event) => event.preventDefault());
    listen('wheel', (event) => this.wheel(event));
    window.addEventListener('blur', () => this.cancel());
    document.addEventListener('visibilitychange', () => document.hidden && this.cancel());
  }

  get state(): InputState {
    if (this.with_role('hand').length > 0) return 'holding';
    return this.with_role('camera').length > 0 ? 'camera' : 'idle';
  }

  /** Whether a pressed pointer is a finger. */
  is_finger(id: number): boolean {
    return this.pointers.some((pointer) => pointer.id === id && pointer.touch);
  }

  /** Lets go of everything. */
  cancel(): void {
    const pointers = this.pointers;
    this.pointers = [];
    for (const pointer of pointers) this.finish(pointer, false);
  }

  /** Makes a hand let go; its pointer does nothing until its release. */
  drop(hand: number): void {
    const pointer = this.pointers.find(({ id }) => id === hand);
    if (pointer) this.spend(pointer);
  }

  /** Brings the hands under their pointers, whose view may have moved. */
  follow(): void {
    for (const { id, x, y } of this.with_role('hand')) this.actions.follow(id, this.locate(x, y));
  }

  private down(event: PointerEvent): void {
    event.preventDefault();
    this.view.focus({ preventScroll: true });
    const touch = event.pointerType === 'touch';
    if (!touch && this.pointers.length > 0) return; // further buttons are ignored
    this.view.setPointerCapture(event.pointerId);
    const point = this.locate(event.clientX, event.clientY);
    if (!touch) this.point = point;
    const pointer = new Pointer(event);
    this.choose_role(pointer, event, point);
    this.pointers.push(pointer);
    if (touch && pointer.role !== 'depth' && this.actions.pressable(pointer.id, point))
      pointer.await_long_press(() => this.press(pointer));
    this.actions.changed();
  }

  private choose_role(pointer: Pointer, event: PointerEvent, point: Vector2): void {
    const touch = event.pointerType === 'touch';
    const object = event.shiftKey && event.ctrlKey;
    const shifts = !touch && !object && (event.button !== 0 || event.shiftKey);
    const { id } = pointer;
    const take = () =>
      object ? this.actions.take_object(id, point) : this.actions.take(id, point);
    if (!shifts && take()) {
      // Fingers beside the cloth belong to the hand from now on.
      for (const other of this.with_role('camera')) other.role = 'depth';
      pointer.role = 'hand';
    } else {
      pointer.role = this.with_role('hand').length > 0 ? 'depth' : 'camera';
      pointer.pans = shifts || (touch && this.after_tap(event));
    }
  }

  private after_tap({ timeStamp, clientX, clientY }: PointerEvent): boolean {
    const { time, x, y } = this.last_tap;
    return timeStamp - time < TAP_TIME && Math.hypot(clientX - x, clientY - y) < TAP_WANDER;
  }

  private move(event: PointerEvent): void {
    if (this.pointers.length === 0) {
      if (event.pointerType !== 'touch') this.point = this.locate(event.clientX, event.clientY);
      this.actions.changed();
      return;
    }
    const pointer = this.pointers.find(({ id }) => id === event.pointerId);
    if (!pointer) return;
    const cameras = this.with_role('camera').map(({ x, y }) => new Vector2(x, y));
    const dy = event.clientY - pointer.y;
    pointer.move(event);
    if (pointer.role === 'camera') this.move_camera(cameras);
    if (pointer.role === 'depth') {
      this.actions.push(Math.exp((-dy / this.view.clientHeight) * FINGER_DEPTH));
      this.actions.changed(); // the hands follow with the next picture
    }
    if (pointer.role !== 'hand') return;
    const point = this.locate(pointer.x, pointer.y);
    if (!pointer.touch) this.point = point;
    this.actions.follow(pointer.id, point);
    this.actions.changed(); // its mark follows at once, though nothing else may move
  }

  private up(event: PointerEvent, meant: boolean): void {
    const place = this.pointers.findIndex(({ id }) => id === event.pointerId);
    if (place < 0) return;
    const [pointer] = this.pointers.splice(place, 1);
    const { timeStamp: time, clientX: x, clientY: y } = event;
    if (pointer.touch && pointer.role === 'camera' && !pointer.moved) this.last_tap = { time, x, y };
    this.finish(pointer, meant);
  }

  /** Ends what a pointer did. */
  private finish(pointer: Pointer, meant: boolean): void {
    const { role } = pointer;
    this.spend(pointer, meant);
    // Fingers that pushed the last hand do not turn to the camera by themselves.
    if (role !== 'hand' || this.state === 'holding') return;
    for (const other of this.with_role('depth')) other.role = 'none';
  }

  private spend(pointer: Pointer, meant = false): void {
    pointer.stop_waiting();
    const { role } = pointer;
    pointer.role = 'none';
    if (role === 'hand') this.actions.let_go(pointer.id, meant);
    this.actions.changed();
  }

  private press(pointer: Pointer): void {
    const point = this.locate(pointer.x, pointer.y);
    this.spend(pointer);
    this.actions.press(point);
  }

  private leave(): void {
    if (this.pointers.length > 0) return;
    this.point = null;
    this.actions.changed();
  }

  private move_camera(before: Vector2[]): void {
    const [first, second] = this.with_role('camera');
    const height = this.view.clientHeight;
    const a = new Vector2(first.x, first.y);
    if (!second) {
      const { x, y } = a.sub(before[0]);
      if (first.pans) this.actions.pan(x / height, -y / height);
      else this.actions.orbit(-x * ORBIT_SPEED, y * ORBIT_SPEED);
      return;
    }
    const b = new Vector2(second.x, second.y);
    const shift = a.clone().add(b).sub(before[0]).sub(before[1]).multiplyScalar(0.5);
    this.actions.pan(shift.x / height, -shift.y / height);
    const spread = a.distanceTo(b);
    const spread_before = before[0].distanceTo(before[1]);
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
    this.actions.changed();
  }

  private with_role(role: Pointer['role']): Pointer[] {
    return this.pointers.filter((pointer) => pointer.role === role);
  }

  private locate(client_x: number, client_y: number): Vector2 {
    const { left, top, width, height } = this.view.getBoundingClientRect();
    const x = ((client_x - left) / width) * 2 - 1;
    return new Vector2(x, 1 - ((client_y - top) / height) * 2);
  }
}


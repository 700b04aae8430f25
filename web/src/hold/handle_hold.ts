import type { Vector2 } from 'three';
import type { Vec3 } from '../../../proto/js/messages.js';
import type { OrbitCamera } from '../view/camera.js';
import { PointerDepth } from './pointer_depth.js';

const SEND_INTERVAL = 40; // between positions of a moving handle [ms]

/**
 * The own hand on anything but cloth: follows the pointer and reports its position now and then.
 */
export abstract class HandleHold {
  private depth: PointerDepth;
  private grip: Vec3; // from the pointer to the moved place [m]
  private timer = 0;

  /**
   * @param position where the pointer meets the thing [m]
   * @param moved the place that is moved [m]
   */
  constructor(pointer: Vector2, position: Vec3, moved: Vec3, camera: OrbitCamera) {
    this.depth = new PointerDepth(camera, position);
    const under = this.depth.under(pointer);
    this.grip = moved.map((value, axis) => value - under[axis]) as Vec3;
  }

  follow(pointer: Vector2): void {
    const under = this.depth.under(pointer);
    const place = under.map((value, axis) => value + this.grip[axis]) as Vec3;
    if (!this.put(place) || this.timer) return;
    this.timer = window.setTimeout(() => this.flush(), SEND_INTERVAL);
  }

  /** @param factor of the distance from the eye */
  push(factor: number): void {
    this.depth.push(factor);
  }

  /** @param _meant whether the hand opened, rather than being broken off */
  end(_meant: boolean): void {
    if (this.timer) this.flush();
  }

  /** Moves the thing to a place [m]; tells whether that changes anything. */
  protected abstract put(place: Vec3): boolean;

  /** Sends the place to the server. */
  protected abstract tell(): void;

  private flush(): void {
    window.clearTimeout(this.timer);
    this.timer = 0;
    this.tell();
  }
}

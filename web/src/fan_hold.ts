import type { Vector2 } from 'three';
import type { Fan, Vec3 } from '../../proto/js/messages.js';
import type { OrbitCamera } from './camera.js';
import { with_handle } from './fans.js';
import type { FanHit, Fans } from './fans.js';

const SEND_INTERVAL = 40; // between places of a fan that moves [ms]
const NEAREST = 0.1; // of the handle to the eye [m]
const FARTHEST = 20; // [m]

/** The own hand on a fan. It moves at once in the own picture; the others see it some ticks later. */
export class FanHold {
  private depth: number;
  private grip: Vec3; // from the pointer to the handle [m]
  private timer = 0;

  constructor(
    private hit: FanHit,
    pointer: Vector2,
    private fans: Fans,
    private camera: OrbitCamera,
    private send: (fans: Fan[]) => void,
  ) {
    this.depth = camera.depth(hit.position);
    const under = camera.point_at(pointer, this.depth);
    this.grip = hit.position.map((value, axis) => value - under[axis]) as Vec3;
  }

  follow(pointer: Vector2): void {
    const under = this.camera.point_at(pointer, this.depth);
    const to = under.map((value, axis) => value + this.grip[axis]) as Vec3;
    const { index, part } = this.hit;
    const list = this.fans.list.map((fan, k) => (k === index ? with_handle(fan, part, to) : fan));
    if (!this.fans.show(list) || this.timer) return;
    this.timer = window.setTimeout(() => this.tell(), SEND_INTERVAL);
  }

  /** @param factor of the distance from the eye */
  push(factor: number): void {
    this.depth = Math.min(FARTHEST, Math.max(NEAREST, this.depth * factor));
  }

  end(): void {
    if (this.timer) this.tell();
  }

  private tell(): void {
    window.clearTimeout(this.timer);
    this.timer = 0;
    this.send(this.fans.list);
  }
}

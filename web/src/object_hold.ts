import type { Vector2 } from 'three';
import type { Vec3 } from '../../proto/js/messages.js';
import type { OrbitCamera } from './camera.js';
import type { ObjectHit } from './objects.js';

const SEND_INTERVAL = 40; // between places of an object that moves [ms]
const SPEED = 2; // at which it follows the hand [m/s]
const NEAREST = 0.1; // of the hand to the eye [m]
const FARTHEST = 20; // [m]

/** Where an object shall go. */
export interface Move {
  position: Vec3;
  speed: number;
}

/** The own hand on an object. The server moves it, and it lags where cloth holds it back. */
export class ObjectHold {
  private depth: number;
  private grip: Vec3; // from the pointer to the object's pivot [m]
  private target: Vec3;
  private timer = 0;

  constructor(
    hit: ObjectHit,
    pointer: Vector2,
    private camera: OrbitCamera,
    private send: (move: Move) => void,
  ) {
    this.depth = camera.depth(hit.position);
    const under = camera.point_at(pointer, this.depth);
    this.grip = hit.pivot.map((value, axis) => value - under[axis]) as Vec3;
    this.target = hit.pivot;
  }

  follow(pointer: Vector2): void {
    const under = this.camera.point_at(pointer, this.depth);
    const target = under.map((value, axis) => value + this.grip[axis]) as Vec3;
    if (target.every((value, axis) => Math.abs(value - this.target[axis]) < 1e-4)) return;
    this.target = target;
    if (!this.timer) this.timer = window.setTimeout(() => this.tell(), SEND_INTERVAL);
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
    this.send({ position: this.target, speed: SPEED });
  }
}

import type { Vector2 } from 'three';
import type { Vec3 } from '../../../proto/js/messages.js';
import type { OrbitCamera } from '../view/camera.js';
import { HandleHold } from './handle_hold.js';
import type { ObjectHit } from '../view/objects.js';

const SPEED = 2; // at which it follows the hand [m/s]

/** Target pose of an object. */
export interface Move {
  position: Vec3;
  speed: number;
}

/** The own hand on an object. The server moves the object, which lags where cloth holds it back. */
export class ObjectHold extends HandleHold {
  private target: Vec3;

  constructor(
    hit: ObjectHit,
    pointer: Vector2,
    camera: OrbitCamera,
    private send: (move: Move) => void,
  ) {
    super(pointer, hit.position, hit.pivot, camera);
    this.target = hit.pivot;
  }

  protected put(place: Vec3): boolean {
    if (place.every((value, axis) => Math.abs(value - this.target[axis]) < 1e-4)) return false;
    this.target = place;
    return true;
  }

  protected tell(): void {
    this.send({ position: this.target, speed: SPEED });
  }
}

import type { Vector2 } from 'three';
import type { Vec3 } from '../../../proto/js/messages.js';
import type { OrbitCamera } from '../view/camera.js';

const NEAREST = 0.1; // distance of a hand from the eye [m]
const FARTHEST = 20; // [m]

/** The plane parallel to the view in which a hand follows the pointer; the wheel moves it. */
export class PointerDepth {
  private depth: number;

  /** @param position where the hand takes hold [m] */
  constructor(
    private camera: OrbitCamera,
    position: Vec3,
  ) {
    this.depth = camera.depth(position);
  }

  /** The point under the pointer [m]. */
  under(pointer: Vector2): Vec3 {
    return this.camera.point_at(pointer, this.depth);
  }

  /** @param factor of the distance from the eye */
  push(factor: number): void {
    this.depth = Math.min(FARTHEST, Math.max(NEAREST, this.depth * factor));
  }
}

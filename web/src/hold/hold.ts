import type { Vector2 } from 'three';
import type { Drag, WeftClient } from '../../../proto/js/index.js';
import type { Vec3 } from '../../../proto/js/messages.js';
import type { OrbitCamera } from '../view/camera.js';
import { PointerDepth } from './pointer_depth.js';
import type { ClothPoint } from '../view/fabric_circle.js';

/** Live: the cloth follows. Sling: it is thrown on release. */
export type HandMode = 'live' | 'sling';

/** A point of the cloth and where it is now [m]. */
export interface ClothPlace extends ClothPoint {
  position: Vec3;
}

/** The own hand in the cloth. Its target stays under the pointer at a depth that the wheel sets. */
export class Hold {
  readonly triangle: number;
  readonly barycentric: Vec3;
  target: Vec3;
  private drag: Drag;
  private depth: PointerDepth;

  /**
   * @param options radius of the held fabric [m]
   * @param lost    called with the reason when the hand lets go other than by `end`
   */
  constructor(
    client: WeftClient,
    { triangle, barycentric, position }: ClothPlace,
    camera: OrbitCamera,
    options: { mode: HandMode; radius: number },
    lost: (reason: string) => void,
  ) {
    this.triangle = triangle;
    this.barycentric = barycentric;
    this.target = position;
    this.depth = new PointerDepth(camera, position);
    this.drag = client.drag({ triangle, barycentric }, { target: position, ...options });
    void this.drag.ended.then((reason) => reason !== 'end' && lost(reason));
  }

  /** The room's number of this hand, once the server has sent it. */
  get grab(): number | null {
    return this.drag.grab;
  }

  /** Moves the target under the pointer; only changes are sent. */
  follow(pointer: Vector2): void {
    const target = this.depth.under(pointer);
    const moved = Math.hypot(...target.map((value, axis) => value - this.target[axis]));
    if (moved < 1e-5) return;
    this.target = target;
    this.drag.move(target);
  }

  /** @param factor of the distance from the eye */
  push(factor: number): void {
    this.depth.push(factor);
  }

  /** @param fire whether a sling gives the cloth its impulse */
  end(fire: boolean): void {
    this.drag.end(fire ? {} : { fire: false });
  }
}

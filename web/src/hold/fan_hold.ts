import type { Vector2 } from 'three';
import type { Fan, Vec3 } from '../../../proto/js/messages.js';
import type { OrbitCamera } from '../view/camera.js';
import { with_handle } from '../view/fans.js';
import type { FanHit, Fans } from '../view/fans.js';
import { HandleHold } from './handle_hold.js';

/** The own hand on a fan. The own picture moves at once; other viewers see it some ticks later. */
export class FanHold extends HandleHold {
  constructor(
    private hit: FanHit,
    pointer: Vector2,
    private fans: Fans,
    camera: OrbitCamera,
    private send: (fans: Fan[]) => void,
  ) {
    super(pointer, hit.position, hit.position, camera);
  }

  protected put(place: Vec3): boolean {
    const { index, part } = this.hit;
    return this.fans.show(
      this.fans.list.map((fan, k) => (k === index ? with_handle(fan, part, place) : fan)),
    );
  }

  protected tell(): void {
    this.send(this.fans.list);
  }
}

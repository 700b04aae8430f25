import type { Vector2 } from 'three';
import type { Pin } from '../../../proto/js/messages.js';
import type { ClothPoint } from '../view/fabric_circle.js';
import type { ClothHit } from '../view/ray.js';
import { tell_refusal } from '../wire/connection.js';
import type { Pointed } from './pointed.js';
import type { Reach } from './reach.js';

export const POINTER_REACH = 16; // of a mouse around a pin [pixels]
export const FINGER_REACH = 28; // of a finger, half its width [pixels]

/** Pins cloth that is held or pointed at, and releases it where it is pinned. */
export class Pinning {
  constructor(
    private reach: Reach,
    private pointed: Pointed,
  ) {}

  /** At a place of the cloth, however it is reached. @returns what is done */
  toggle(place: ClothPoint): 'pinned' | 'freed' {
    return this.apply(place, this.pointed.pins(null, this.nearest_corner(place), 0));
  }

  /**
   * At the cloth or the pin under a point, within some pixels.
   * @returns what is done; null if nothing is there
   */
  toggle_at(point: Vector2, pixels: number): 'pinned' | 'freed' | null {
    const hit = this.pointed.cloth(point);
    // A fan cannot be pinned, and hides what is behind it.
    if (this.pointed.fan(point, hit)) return null;
    const pins = this.pointed.pins(point, hit && this.nearest_corner(hit), pixels);
    const place = pins.length ? hit : this.cloth_at(point, pixels);
    return pins.length || place ? this.apply(place, pins) : null;
  }

  /** Whether a finger that rests at a point would pin or release something. */
  within_reach(point: Vector2): boolean {
    if (this.pointed.fan(point, this.pointed.cloth(point))) return false;
    const pins = this.pointed.pins(point, null, FINGER_REACH);
    return pins.length > 0 || this.cloth_at(point, FINGER_REACH) !== null;
  }

  /** A finger covers what it points at, so it also means the cloth beside it. */
  private cloth_at(point: Vector2, pixels: number): ClothHit | null {
    return pixels >= FINGER_REACH
      ? this.pointed.cloth_near(point, pixels)
      : this.pointed.cloth(point);
  }

  private apply(place: ClothPoint | null, pins: Pin[]): 'pinned' | 'freed' {
    const { client, tell } = this.reach;
    for (const { id } of pins) tell_refusal(client.release({ pin: id }), tell);
    if (pins.length || !place) return 'freed';
    const { triangle, barycentric } = place;
    tell_refusal(client.pin({ triangle, barycentric }), tell);
    return 'pinned';
  }

  /** The particle that the server pins for a point of a triangle. */
  private nearest_corner({ triangle, barycentric }: ClothPoint): number | null {
    const corner = barycentric.indexOf(Math.max(...barycentric));
    return this.reach.world()?.triangles[triangle * 3 + corner] ?? null;
  }
}

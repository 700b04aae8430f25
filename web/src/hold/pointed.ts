import { Vector2 } from 'three';
import type { Pin } from '../../../proto/js/messages.js';
import type { FanHit } from '../view/fans.js';
import type { ObjectHit } from '../view/objects.js';
import type { ClothHit } from '../view/ray.js';
import type { Reach } from './reach.js';

const RINGS = 3; // of rays around a point, to find cloth near it
const RAYS = 12; // a ring

/** What lies under a point of the view, in normalised device coordinates. */
export class Pointed {
  constructor(private reach: Reach) {}

  /** The cloth there, unless an object hides it. */
  cloth(point: Vector2 | null): ClothHit | null {
    if (!point || !this.reach.client.connected) return null;
    return this.reach.world()?.hit(this.reach.orbit.ray(point)) ?? null;
  }

  /** The cloth there, or else the nearest within some pixels. */
  cloth_near(point: Vector2, pixels: number): ClothHit | null {
    const there = this.cloth(point);
    if (there) return there;
    const { width, height } = this.reach.size();
    for (let ring = 1; ring <= RINGS; ring++) {
      const distance = (2 * pixels * ring) / RINGS;
      for (let ray = 0; ray < RAYS; ray++) {
        const angle = (2 * Math.PI * ray) / RAYS;
        const offset = new Vector2(Math.cos(angle) / width, Math.sin(angle) / height);
        const hit = this.cloth(offset.multiplyScalar(distance).add(point));
        if (hit) return hit;
      }
    }
    return null;
  }

  /** The handle of a fan there, unless cloth is in front of it. */
  fan(point: Vector2 | null, cloth: ClothHit | null): FanHit | null {
    if (!point || !this.reach.client.connected) return null;
    const { width, height } = this.reach.size();
    const { orbit } = this.reach;
    const hit = this.reach.fans.at(point, orbit, width, height);
    if (!hit || !cloth) return hit;
    return orbit.depth(hit.position) < orbit.depth(cloth.position) ? hit : null;
  }

  /** The object there, unless cloth is in front of it. */
  object(point: Vector2): ObjectHit | null {
    if (!this.reach.client.connected) return null;
    return this.reach.world()?.hit_object(this.reach.orbit.ray(point)) ?? null;
  }

  /**
   * Pins at the place nearest to a point, within some pixels, and those at a particle.
   * @param point    null: no place is meant
   * @param particle null: no particle is meant
   */
  pins(point: Vector2 | null, particle: number | null, pixels: number): Pin[] {
    const { pins, orbit } = this.reach;
    const { width, height } = this.reach.size();
    return pins.at({ point, particle, pixels }, orbit.camera, width, height);
  }
}

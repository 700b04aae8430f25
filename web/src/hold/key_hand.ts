import { Vector2, Vector3 } from 'three';
import type { ClothPoint } from '../view/fabric_circle.js';
import { point_on_triangle } from '../view/ray.js';
import type { ClothHit } from '../view/ray.js';
import type { Holding } from './holding.js';
import type { Pointed } from './pointed.js';
import type { Reach } from './reach.js';

export const KEY_HAND = -1; // in place of a pointer's number
const STEP = 12; // of the cursor or the hand for a key [pixels]
const SHORTER_STEPS = [1, 0.5, 0.25]; // tried one after the other where the cloth ends
const DEPTH_STEP = 1.04; // factor of the distance from the eye
const MOST_TRIED = 200; // particles at which a cursor may begin

/** What the keyboard's hand needs of the page. */
export interface KeyReach extends Reach {
  /** Says something to those who do not see the picture. */
  announce(text: string): void;
  changed(): void;
}

/**
 * The hand of the keyboard. A cursor on the cloth shows where it would take hold; while it holds, it
 * moves in the plane of the view as a pointer does.
 */
export class KeyHand {
  /** Where the cursor is; null while there is none. */
  cursor: ClothPoint | null = null;
  private point: Vector2 | null = null; // of the view, while it holds

  constructor(
    private reach: KeyReach,
    private pointed: Pointed,
    private holding: Holding,
  ) {}

  get holds(): boolean {
    return this.point !== null;
  }

  /** Puts the cursor on the cloth, or takes it away. */
  toggle(): void {
    if (this.cursor) return this.leave();
    if (!this.holding.allowed) return this.reach.tell('You only look, and cannot take the cloth');
    this.cursor = this.nearest_to_middle();
    this.say(this.cursor ? 'Cursor on the cloth' : 'No cloth in view');
  }

  /**
   * Moves the cursor, or the hand that holds.
   * @param x, y    direction on the screen, to the right and up
   * @param in_depth moves the hand away (up) and near (down)
   * @returns whether there is anything to move
   */
  arrow(x: number, y: number, in_depth: boolean): boolean {
    if (!this.cursor) return false;
    if (this.point && in_depth) {
      if (y) this.holding.push(DEPTH_STEP ** y, KEY_HAND);
    } else if (this.point) {
      this.point.add(this.step(x, y)).clampScalar(-1, 1);
    } else {
      this.move_cursor(this.cursor, this.step(x, y));
    }
    this.follow();
    this.reach.changed();
    return true;
  }

  /** Takes hold at the cursor, or lets go. @returns whether there is a cursor */
  enter(): boolean {
    if (!this.cursor) return false;
    if (this.point) this.let_go(true);
    else this.take(this.cursor);
    return true;
  }

  /** Lets go, or takes the cursor away. @returns whether there was anything to end */
  escape(): boolean {
    if (!this.cursor) return false;
    if (this.point) this.let_go(false);
    else this.leave();
    return true;
  }

  /** Pins what it holds or points at, or releases it. @returns whether there is a cursor */
  toggle_pin(): boolean {
    if (!this.cursor) return false;
    if (!this.reach.client.connected) return true;
    this.say(this.holding.pinning.toggle(this.cursor) === 'pinned' ? 'Pinned' : 'Freed');
    return true;
  }

  /** Brings the hand to its place in a view that may have moved. */
  follow(): void {
    if (this.point) this.holding.follow(KEY_HAND, this.point);
  }

  /** Lets go without opening the hand, as when the window loses the focus. */
  cancel(): void {
    if (this.point) this.let_go(false);
  }

  /** Forgets a cloth that is gone. */
  forget(): void {
    this.cancel();
    this.cursor = null;
  }

  private take(cursor: ClothPoint): void {
    const place = this.place_of(cursor);
    const { x, y } = this.project(place);
    this.holding.take_cloth(KEY_HAND, { ...cursor, position: place });
    this.point = new Vector2(x, y);
    this.say('Holding');
  }

  private let_go(meant: boolean): void {
    this.point = null;
    this.holding.let_go(KEY_HAND, meant);
    this.say('Let go');
  }

  private leave(): void {
    this.forget();
    this.say('Cursor away');
  }

  private move_cursor(cursor: ClothPoint, step: Vector2): void {
    const from = this.project(this.place_of(cursor));
    for (const part of SHORTER_STEPS) {
      const hit = this.pointed.cloth(step.clone().multiplyScalar(part).add(from));
      if (!hit) continue;
      this.cursor = hit;
      return;
    }
    this.say('Edge of the cloth');
  }

  /** The visible cloth at the particle nearest to the middle of the view. */
  private nearest_to_middle(): ClothHit | null {
    const positions = this.reach.world()?.playback.positions ?? [];
    const seen: { place: Vector2; distance: number }[] = [];
    const point = new Vector3();
    for (let i = 0; i < positions.length; i += 3) {
      point.fromArray(positions, i).project(this.reach.orbit.camera);
      const place = new Vector2(point.x, point.y);
      if (Math.abs(point.z) < 1) seen.push({ place, distance: place.length() });
    }
    seen.sort((a, b) => a.distance - b.distance);
    for (const { place } of seen.slice(0, MOST_TRIED)) {
      // A little inwards, so that the corner of a cloth is hit too.
      const hit = this.pointed.cloth(place) ?? this.pointed.cloth(place.multiplyScalar(0.999));
      if (hit) return hit;
    }
    return null;
  }

  private place_of({ triangle, barycentric }: ClothPoint) {
    const { playback, triangles } = this.reach.world()!;
    return point_on_triangle(triangle, barycentric, playback.positions, triangles);
  }

  private project(place: [number, number, number]): Vector2 {
    const { x, y } = new Vector3(...place).project(this.reach.orbit.camera);
    return new Vector2(x, y);
  }

  private step(x: number, y: number): Vector2 {
    const { width, height } = this.reach.size();
    return new Vector2((2 * STEP * x) / width, (2 * STEP * y) / height);
  }

  private say(text: string): void {
    this.reach.announce(text);
    this.reach.changed();
  }
}

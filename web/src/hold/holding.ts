import type { Vector2 } from 'three';
import type { Grab } from '../../../proto/js/messages.js';
import type { Hand } from '../view/hands.js';
import type { ClothHit } from '../view/ray.js';
import { drawn_hands } from './drawn_hands.js';
import { FanHold } from './fan_hold.js';
import { Hold } from './hold.js';
import type { ClothPlace } from './hold.js';
import { FINGER_REACH, Pinning, POINTER_REACH } from './pinning.js';
import { Pointed } from './pointed.js';
import type { Reach } from './reach.js';
import { Taking } from './taking.js';
import type { Held } from './taking.js';

const RADIUS = 0.03; // that a hand takes of the fabric at first [m]
const NARROWEST = 0.005;
const WIDEST = 0.5;

/**
 * What the own hands hold: cloth, fans, grippers or objects. Each finger is a hand and so is the
 * mouse; a hand has the number of its pointer. And the pins that they set.
 */
export class Holding {
  readonly pinning: Pinning;
  readonly taking: Taking;
  /** Where the idle pointer would take the cloth. */
  hovered: ClothHit | null = null;
  /** Of the fabric that a hand takes [m]. */
  radius = RADIUS;
  /** Hands of all viewers, as the server last told. */
  grabs: Grab[] = [];
  readonly pointed: Pointed;
  private held = new Map<number, Held>();

  constructor(private reach: Reach) {
    this.pointed = new Pointed(reach);
    this.pinning = new Pinning(reach, this.pointed);
    this.taking = new Taking(reach, this.pointed, () => this.radius);
  }

  /** Whether the viewer may hold anything. */
  get allowed(): boolean {
    return this.reach.viewer(this.reach.client.viewer)?.hand !== false;
  }

  get holds_cloth(): boolean {
    return this.cloths.length > 0;
  }

  get holds_fan(): boolean {
    return [...this.held.values()].some((held) => held instanceof FanHold);
  }

  follow(hand: number, point: Vector2): void {
    this.held.get(hand)?.follow(point);
  }

  /**
   * Moves what is held away from the eye.
   * @param factor of the distance
   * @param hand   that holds it; by default all of them
   */
  push(factor: number, hand?: number): void {
    for (const [each, held] of this.held) if (hand === undefined || each === hand) held.push(factor);
  }

  /** Takes what is first at a point; tells whether there is anything. */
  take(hand: number, point: Vector2): boolean {
    return this.keep(hand, this.taking.take(hand, point));
  }

  /** Takes the object at a point; tells whether there is one. */
  take_object(hand: number, point: Vector2): boolean {
    return this.keep(hand, this.taking.object(point, true));
  }

  /** Takes the cloth at a place of it, however that was found. */
  take_cloth(hand: number, place: ClothPlace): void {
    this.held.set(hand, this.taking.cloth(hand, place));
  }

  /** @param meant whether the pointer was released, so that a sling throws the cloth */
  let_go(hand: number, meant: boolean): void {
    const held = this.held.get(hand);
    this.held.delete(hand);
    held?.end(meant);
  }

  /** Pins all held points, or releases those that are pinned; without any, the same at the mouse. */
  toggle_pin(mouse: Vector2 | null): void {
    if (!this.reach.client.connected || !this.reach.world()) return;
    if (this.holds_fan) return;
    if (this.holds_cloth) for (const hold of this.cloths) this.pinning.toggle(hold);
    else if (mouse) this.pinning.toggle_at(mouse, POINTER_REACH);
  }

  /** Whether a finger that rests at a point would pin or release something. */
  pressable(hand: number, point: Vector2): boolean {
    const held = this.held.get(hand);
    return held ? held instanceof Hold : this.pinning.within_reach(point);
  }

  /** Pins or releases what is within the width of a finger that rested there. */
  press(point: Vector2): void {
    if (this.reach.client.connected) this.pinning.toggle_at(point, FINGER_REACH);
  }

  /** Looks under an idle pointer. @returns whether something there can be taken by this viewer */
  hover(point: Vector2 | null): boolean {
    return this.takes_at(point) && this.allowed;
  }

  /** The hands in the cloth as they are drawn. */
  hands(): Hand[] {
    const world = this.reach.world();
    const own = [...this.held].filter((each): each is [number, Hold] => each[1] instanceof Hold);
    return world ? drawn_hands(this.reach, world, this.grabs, own) : [];
  }

  /** Makes hands hold more or less of the cloth. @param factor of the radius */
  widen(factor: number): void {
    this.radius = Math.min(WIDEST, Math.max(NARROWEST, this.radius * factor));
  }

  private takes_at(point: Vector2 | null): boolean {
    this.hovered = this.pointed.cloth(point);
    const fan = this.pointed.fan(point, this.hovered);
    if (fan) this.hovered = null;
    if (!point || this.hovered || fan) return this.hovered !== null || fan !== null;
    return this.taking.can_take_object(point);
  }

  private get cloths(): Hold[] {
    return [...this.held.values()].filter((held) => held instanceof Hold);
  }

  private keep(hand: number, held: Held | null): boolean {
    if (held) this.held.set(hand, held);
    return held !== null;
  }
}

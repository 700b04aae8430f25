import type { Vector2 } from 'three';
import type { WeftClient } from '../../../proto/js/index.js';
import type { Grab, Viewer } from '../../../proto/js/messages.js';
import type { OrbitCamera } from '../view/camera.js';
import type { FanHit, Fans } from '../view/fans.js';
import { NO_COLOR, owner_of } from '../view/hands.js';
import type { Hand } from '../view/hands.js';
import type { Pins } from '../view/pins.js';
import { point_on_triangle } from '../view/ray.js';
import type { ClothHit } from '../view/ray.js';
import type { WorldView } from '../view/world_view.js';
import { tell_refusal } from '../wire/connection.js';
import { FanHold } from './fan_hold.js';
import { Hold } from './hold.js';
import type { HandMode } from './hold.js';
import { ObjectHold } from './object_hold.js';

/** What a hand reaches for, and where it reports to. */
export interface Reach {
  readonly client: WeftClient;
  readonly orbit: OrbitCamera;
  readonly fans: Fans;
  readonly pins: Pins;
  world(): WorldView | null;
  viewer(id: number): Viewer | undefined;
  hand_mode(): HandMode;
  /** Size of the view [pixels]. */
  size(): { width: number; height: number };
  /** Shows the fans as the server has them, unless one is held. */
  show_fans(): void;
  tell(text: string): void;
  /** The hand let go of the cloth without being told to. */
  lost(reason: string): void;
}

/** What the pointer holds: cloth, a fan or an object. And the pins that it sets. */
export class Holding {
  /** Where the idle pointer would take the cloth. */
  hovered: ClothHit | null = null;
  /** Hands of all viewers, as the server last told. */
  grabs: Grab[] = [];
  private cloth: Hold | null = null;
  private fan: FanHold | null = null;
  private object: ObjectHold | null = null;

  constructor(private reach: Reach) {}

  get holds_cloth(): boolean {
    return this.cloth !== null;
  }

  get holds_fan(): boolean {
    return this.fan !== null;
  }

  follow(point: Vector2): void {
    (this.fan ?? this.object ?? this.cloth)?.follow(point);
  }

  /** Moves what is held away from the eye. @param factor of the distance */
  push(factor: number): void {
    (this.fan ?? this.object ?? this.cloth)?.push(factor);
  }

  /** Takes the cloth or a fan at a point; tells whether there is one. */
  take(point: Vector2): boolean {
    const { client, orbit, hand_mode, lost } = this.reach;
    const hit = this.pick(point);
    if (this.take_fan(point, hit)) return true;
    if (!hit) return false;
    this.cloth = new Hold(client, hit, orbit, hand_mode(), lost);
    return true;
  }

  /** Takes the object at a point; tells whether there is one. */
  take_object(point: Vector2): boolean {
    const { client, orbit, tell } = this.reach;
    if (!client.connected) return false;
    const hit = this.reach.world()?.hit_object(orbit.ray(point));
    if (!hit) return false;
    this.object = new ObjectHold(hit, point, orbit, (move) =>
      tell_refusal(client.move(hit.name, move), tell),
    );
    return true;
  }

  /** @param meant whether the pointer was released, so that a sling throws the cloth */
  let_go(meant: boolean): void {
    this.fan?.end();
    this.object?.end();
    this.cloth?.end(meant);
    this.fan = this.object = this.cloth = null;
  }

  /** Pins the held or indicated point, or releases it if it is pinned. */
  toggle_pin(point: Vector2 | null): void {
    const { client, orbit, tell } = this.reach;
    if (!client.connected || !this.reach.world()) return;
    const held = this.cloth;
    const hit = held ? null : this.pick(point);
    // A fan cannot be pinned, and hides what is behind it.
    if (this.fan || (!held && this.fan_at(point, hit))) return;
    const at = held ?? hit;
    const particle = at && this.nearest_corner(at);
    const { width, height } = this.reach.size();
    const meant = held ? null : point;
    const pins = this.reach.pins.at(meant, particle, orbit.camera, width, height);
    const answers = pins.length
      ? pins.map(({ id }) => client.release({ pin: id }))
      : at
        ? [client.pin({ triangle: at.triangle, barycentric: at.barycentric })]
        : [];
    for (const answer of answers) tell_refusal(answer, tell);
  }

  /** Looks under an idle pointer. @returns whether something there can be taken */
  hover(point: Vector2 | null): boolean {
    this.hovered = this.pick(point);
    const fan = this.fan_at(point, this.hovered);
    if (fan) this.hovered = null;
    return this.hovered !== null || fan !== null;
  }

  /** The own hand at the pointer, others as in the shown frame. */
  hands(): Hand[] {
    const { client, viewer } = this.reach;
    const world = this.reach.world();
    const own_hold = this.cloth;
    if (!world) return [];
    const place = ({ triangle, barycentric }: Pick<ClothHit, 'triangle' | 'barycentric'>) =>
      point_on_triangle(triangle, barycentric, world.playback.positions, world.triangles);
    const hands = this.grabs
      .filter((grab) => grab.viewer !== client.viewer && grab.id !== own_hold?.grab)
      .map((grab): Hand => {
        const sample = world.playback.grabs.find(({ id }) => id === grab.id);
        const target = (sample?.target ?? grab.target) as Hand['target'];
        return { ...owner_of(grab, viewer(grab.viewer)), held: place(grab), target };
      });
    if (own_hold) {
      const own = viewer(client.viewer);
      hands.push({
        id: own_hold.grab ?? 0,
        name: own?.name ?? '',
        color: own?.color ?? NO_COLOR,
        held: place(own_hold),
        target: own_hold.target,
        own: true,
      });
    }
    return hands;
  }

  private pick(point: Vector2 | null): ClothHit | null {
    if (!point || !this.reach.client.connected) return null;
    return this.reach.world()?.hit(this.reach.orbit.ray(point)) ?? null;
  }

  /** Takes the handle of a fan, unless cloth is in front of it. */
  private take_fan(point: Vector2, cloth: ClothHit | null): boolean {
    const { client, orbit, tell } = this.reach;
    const hit = this.fan_at(point, cloth);
    if (!hit) return false;
    this.fan = new FanHold(hit, point, this.reach.fans, orbit, (fans) => {
      const answer = client.set({ fans });
      this.reach.fans.told(answer);
      answer.catch(() => this.reach.show_fans()); // if refused, they stay where they were
      tell_refusal(answer, tell);
    });
    return true;
  }

  private fan_at(point: Vector2 | null, cloth: ClothHit | null): FanHit | null {
    if (!point || !this.reach.client.connected) return null;
    const { width, height } = this.reach.size();
    const { orbit } = this.reach;
    const hit = this.reach.fans.at(point, orbit, width, height);
    if (!hit || !cloth) return hit;
    return orbit.depth(hit.position) < orbit.depth(cloth.position) ? hit : null;
  }

  /** The particle that the server pins for a point of a triangle. */
  private nearest_corner({ triangle, barycentric }: Pick<ClothHit, 'triangle' | 'barycentric'>) {
    const corner = barycentric.indexOf(Math.max(...barycentric));
    return this.reach.world()?.triangles[triangle * 3 + corner] ?? null;
  }
}

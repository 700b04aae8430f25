import type { Vector2 } from 'three';
import type { Vec3 } from '../../../proto/js/messages.js';
import type { ObjectHit } from '../view/objects.js';
import type { ClothHit } from '../view/ray.js';
import { tell_refusal } from '../wire/connection.js';
import { FanHold } from './fan_hold.js';
import { GripperHold } from './gripper_hold.js';
import { Grippers } from './grippers.js';
import { Hold } from './hold.js';
import type { ClothPlace } from './hold.js';
import { ObjectHold } from './object_hold.js';
import type { Pointed } from './pointed.js';
import type { Reach } from './reach.js';

/** What one hand holds. */
export interface Held {
  follow(point: Vector2): void;
  /** @param factor of the distance from the eye */
  push(factor: number): void;
  /** @param meant whether the hand opened, rather than being broken off */
  end(meant: boolean): void;
}

/** Takes what is first at a point: the cloth, a fan, a gripper or another object. */
export class Taking {
  readonly grippers: Grippers;

  /** @param radius of the fabric that a hand takes [m] */
  constructor(
    private reach: Reach,
    private pointed: Pointed,
    private radius: () => number,
  ) {
    this.grippers = new Grippers(reach.client, reach.tell);
  }

  /** @returns null if nothing there can be taken */
  take(hand: number, point: Vector2): Held | null {
    const cloth = this.pointed.cloth(point);
    const fan = this.fan(point, cloth);
    if (fan || !cloth) return fan ?? this.object(point, this.reach.moves_objects());
    return this.cloth(hand, cloth);
  }

  /** Takes the gripper at a point, or another object if such is wanted. */
  object(point: Vector2, wanted: boolean): Held | null {
    const { client, orbit, tell } = this.reach;
    const hit = this.pointed.object(point);
    const gripper = this.gripper_of(hit);
    if (hit && gripper) {
      return new GripperHold(hit.position, gripper.middle, point, orbit, {
        carry: (position) => this.grippers.carry(gripper.name, position),
        squeeze: () => this.grippers.squeeze(gripper.name),
      });
    }
    if (!hit || !wanted) return null;
    return new ObjectHold(hit, point, orbit, (move) =>
      tell_refusal(client.move({ collider: hit.place }, move), tell),
    );
  }

  /** Whether a hand that is no cloth's would take an object at a point. */
  can_take_object(point: Vector2): boolean {
    const all = this.reach.moves_objects();
    if (!all && this.grippers.none) return false;
    const hit = this.pointed.object(point);
    return hit !== null && (all || this.gripper_of(hit) !== null);
  }

  /** Closes or opens the gripper at a point; without one there, all of them. */
  squeeze(point: Vector2 | null): void {
    const gripper = this.gripper_of(point && this.pointed.object(point));
    if (gripper) this.grippers.squeeze(gripper.name);
    else this.grippers.squeeze_all();
  }

  cloth(hand: number, place: ClothPlace): Hold {
    const { client, orbit, hand_mode, lost } = this.reach;
    const options = { mode: hand_mode(), radius: this.radius() };
    return new Hold(client, place, orbit, options, (reason) => lost(hand, reason));
  }

  /** Takes the handle of a fan, unless cloth is in front of it. */
  private fan(point: Vector2, cloth: ClothHit | null): FanHold | null {
    const { client, orbit, tell } = this.reach;
    const hit = this.pointed.fan(point, cloth);
    if (!hit) return null;
    return new FanHold(hit, point, this.reach.fans, orbit, (fans) => {
      const answer = client.set({ fans });
      this.reach.fans.told(answer);
      answer.catch(() => this.reach.show_fans()); // if refused, they stay where they were
      tell_refusal(answer, tell);
    });
  }

  /** The gripper that an object is a jaw of, and the middle between its jaws [m]. */
  private gripper_of(hit: ObjectHit | null): { name: string; middle: Vec3 } | null {
    const world = this.reach.world();
    const gripper = hit && world && this.grippers.of_jaw(world.announcement.colliders, hit.place);
    if (!gripper) return null;
    const jaws = world.object_poses().filter(({ place }) => gripper.jaws.includes(place));
    const middle = [0, 1, 2].map(
      (axis) => jaws.reduce((sum, { position }) => sum + position[axis], 0) / jaws.length,
    ) as Vec3;
    return { name: gripper.name, middle };
  }
}

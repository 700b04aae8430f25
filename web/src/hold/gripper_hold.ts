import type { Vector2 } from 'three';
import type { Vec3 } from '../../../proto/js/messages.js';
import type { OrbitCamera } from '../view/camera.js';
import { HandleHold } from './handle_hold.js';

const TAP_WANDER = 0.025; // of a pointer that taps, in normalised device coordinates

/** The own hand on a gripper's jaw: a drag carries the gripper, a tap closes or opens it. */
export class GripperHold extends HandleHold {
  private target: Vec3;
  private carries = false;

  /**
   * @param position where the pointer meets the jaw [m]
   * @param middle   between the jaws [m]
   */
  constructor(
    position: Vec3,
    middle: Vec3,
    private start: Vector2,
    camera: OrbitCamera,
    private actions: { carry(position: Vec3): void; squeeze(): void },
  ) {
    super(start, position, middle, camera);
    this.target = middle;
  }

  override follow(pointer: Vector2): void {
    this.carries ||= pointer.distanceTo(this.start) > TAP_WANDER;
    if (this.carries) super.follow(pointer);
  }

  override push(factor: number): void {
    this.carries = true;
    super.push(factor);
  }

  override end(meant: boolean): void {
    super.end(meant);
    if (meant && !this.carries) this.actions.squeeze();
  }

  protected put(place: Vec3): boolean {
    if (place.every((value, axis) => Math.abs(value - this.target[axis]) < 1e-4)) return false;
    this.target = place;
    return true;
  }

  protected tell(): void {
    this.actions.carry(this.target);
  }
}

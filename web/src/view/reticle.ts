import { Group } from 'three';
import type { PerspectiveCamera } from 'three';
import type { Vec3 } from '../../../proto/js/messages.js';
import type { ClothPoint } from './fabric_circle.js';
import { MarkLine } from './marks.js';
import type { WorldView } from './world_view.js';

const WIDTH = 1.8; // of the ring [pixels]
const BORDER = 1.4; // of the dark line around it, on each side [pixels]
const LIFT = 0.004; // towards the eye, of the distance to it

/** A ring on the cloth around what a hand would hold, at its true size in the fabric. */
export class Reticle {
  readonly group = new Group();
  /** The points of the ring [m]; none if it is not shown. */
  shown: Vec3[] = [];
  private border = new MarkLine(WIDTH + 2 * BORDER, 0.45, 10, '#1d2025');
  private ring = new MarkLine(WIDTH, 0.95, 11);

  constructor() {
    this.group.add(this.border.group, this.ring.group);
    this.group.visible = false;
  }

  /**
   * @param centre of the ring; null: none is shown
   * @param radius in the fabric [m]
   */
  update(
    centre: ClothPoint | null,
    radius: number,
    world: WorldView | null,
    camera: PerspectiveCamera,
    { width, height }: { width: number; height: number },
  ): void {
    this.group.visible = centre !== null && world !== null;
    this.shown = [];
    if (!centre || !world) return;
    this.shown = world.circle.around(centre, radius, world.playback.positions);
    const eye = camera.position.toArray();
    // The drawn cloth is rounder than its triangles and must not cover the ring.
    const lifted = this.shown.map((p) => p.map((v, k) => v + LIFT * (eye[k] - v)) as Vec3);
    for (const line of [this.border, this.ring]) line.set(lifted, width, height);
  }
}

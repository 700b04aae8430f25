import { DoubleSide, Group, Mesh, MeshBasicMaterial, RingGeometry, Vector3 } from 'three';
import type { PerspectiveCamera } from 'three';
import { scale_to_pixels } from './hands.js';
import type { ClothHit } from './ray.js';
import { point_on_triangle } from './ray.js';
import type { WorldView } from './world_view.js';

const RADIUS = 7; // [pixels]

/** A ring on the cloth that shows where the pointer would hold it. */
export class Reticle {
  readonly group = new Group();

  constructor() {
    const material = new MeshBasicMaterial({
      color: '#ffffff',
      side: DoubleSide,
      transparent: true,
      opacity: 0.85,
      depthTest: false,
    });
    const ring = new Mesh(new RingGeometry(0.72, 1, 40), material);
    ring.renderOrder = 10;
    this.group.add(ring);
    this.group.visible = false;
  }

  update(
    hit: ClothHit | null,
    world: WorldView | null,
    camera: PerspectiveCamera,
    height: number,
  ): void {
    this.group.visible = hit !== null && world !== null;
    if (!hit || !world) return;
    const { positions } = world.playback;
    const corner = (weights: number[]) =>
      new Vector3(...point_on_triangle(hit.triangle, weights, positions, world.triangles));
    const a = corner([1, 0, 0]);
    const normal = corner([0, 1, 0]).sub(a).cross(corner([0, 0, 1]).sub(a)).normalize();
    scale_to_pixels(this.group, hit.position, RADIUS, camera, height);
    this.group.lookAt(this.group.position.clone().add(normal));
  }
}

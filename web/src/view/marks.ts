import { GreaterDepth, Group, LessEqualDepth, Mesh, MeshBasicMaterial, SphereGeometry } from 'three';
import type { ColorRepresentation, Material, PerspectiveCamera, Vector3 } from 'three';
import { Line2 } from 'three/examples/jsm/lines/Line2.js';
import { LineGeometry } from 'three/examples/jsm/lines/LineGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import type { Vec3 } from '../../../proto/js/messages.js';

const HIDDEN = 0.3; // of the opacity that a mark has where cloth or objects hide it
const RIM = 1.4; // of a dot, in radii of its core

// Marks are drawn twice: as they are where nothing is in front of them, and fainter elsewhere.

/** A line over the picture, fainter where cloth or objects hide it. */
export class MarkLine {
  readonly group = new Group();
  private geometry = new LineGeometry();
  private materials: LineMaterial[];
  private points = 0;

  /**
   * @param width [pixels]
   * @param order of drawing, among transparent things
   */
  constructor(width: number, opacity: number, order: number, color: ColorRepresentation = '#ffffff') {
    const options = { linewidth: width, opacity, color, transparent: true, depthWrite: false };
    this.materials = seen_and_hidden(() => new LineMaterial(options));
    for (const material of this.materials) {
      const line = new Line2(this.geometry, material);
      line.frustumCulled = false; // its bounds would have to follow it
      line.renderOrder = order;
      this.group.add(line);
    }
  }

  set color(color: ColorRepresentation) {
    for (const material of this.materials) material.color.set(color);
  }

  /** @param width, height of the view [pixels] */
  set(points: Vec3[], width: number, height: number): void {
    for (const material of this.materials) material.resolution.set(width, height);
    if (points.length !== this.points) {
      this.points = points.length;
      this.geometry.dispose();
      this.geometry.setPositions(points.flat());
      return;
    }
    // New buffers for each picture would fill the memory of the graphics.
    const { data } = this.geometry.attributes.instanceStart as unknown as {
      data: { array: Float32Array; needsUpdate: boolean };
    };
    for (let n = 0; n + 1 < points.length; n++)
      data.array.set([...points[n], ...points[n + 1]], n * 6);
    data.needsUpdate = true;
  }

  dispose(): void {
    this.group.removeFromParent();
    this.geometry.dispose();
    for (const material of this.materials) material.dispose();
  }
}

/** A dot with a white rim, visible on cloth of the same colour. */
export class MarkDot {
  readonly group = new Group();
  private sphere = new SphereGeometry(1, 20, 12);
  private rims = seen_and_hidden(() => new MeshBasicMaterial({ color: '#ffffff' }));
  private cores = seen_and_hidden(() => new MeshBasicMaterial());

  constructor(
    private pixels: number,
    order: number,
  ) {
    const add = (materials: Material[], scale: number, place: number) => {
      for (const material of materials) {
        const mesh = new Mesh(this.sphere, material);
        mesh.scale.setScalar(scale);
        mesh.renderOrder = place;
        this.group.add(mesh);
      }
    };
    add(this.rims, 1, order);
    add(this.cores, 1 / RIM, order + 1);
  }

  set color(color: ColorRepresentation) {
    for (const material of this.cores) material.color.set(color);
  }

  /** @param height of the view [pixels] */
  set(place: Vec3, camera: PerspectiveCamera, height: number): void {
    scale_to_pixels(this.group, place, this.pixels, camera, height);
    // In front of the cloth that it marks, whose drawn surface is rounder and thicker.
    const { position, scale } = this.group;
    position.addScaledVector(camera.position.clone().sub(position).normalize(), scale.x);
  }

  dispose(): void {
    this.group.removeFromParent();
    this.sphere.dispose();
    for (const material of [...this.rims, ...this.cores]) material.dispose();
  }
}

/** One material for where nothing is in front, and a fainter one for elsewhere. */
function seen_and_hidden<Kind extends Material>(make: () => Kind): [Kind, Kind] {
  const [seen, hidden] = [make(), make()];
  for (const material of [seen, hidden]) {
    material.transparent = true;
    material.depthWrite = false;
  }
  seen.depthFunc = LessEqualDepth;
  hidden.depthFunc = GreaterDepth;
  hidden.opacity *= HIDDEN;
  return [seen, hidden];
}

/** Positions an object and scales it to a size in pixels. */
function scale_to_pixels(
  object: { position: Vector3; scale: Vector3 },
  place: Vec3,
  pixels: number,
  camera: PerspectiveCamera,
  height: number,
): void {
  object.position.set(...place);
  const depth = object.position.clone().applyMatrix4(camera.matrixWorldInverse).z;
  const height_there = 2 * Math.abs(depth) * Math.tan((camera.fov * Math.PI) / 360);
  object.scale.setScalar((pixels * height_there) / height);
}

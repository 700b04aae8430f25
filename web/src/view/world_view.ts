import { Box3, Vector3 } from 'three';
import type { Camera, Group } from 'three';
import type { Frame, Look, MeshData, MeshAnnouncement, Vec3 } from '../../../proto/js/messages.js';
import { ClothMesh, levels_of } from './cloth_mesh.js';
import type { Subject } from './director.js';
import { Objects } from './objects.js';
import type { ObjectHit } from './objects.js';
import { FabricCircle } from './fabric_circle.js';
import { Playback } from '../wire/playback.js';
import { cast_ray } from './ray.js';
import type { ClothHit } from './ray.js';
import type { Stage } from './stage.js';

const CLEARANCE = 0.02; // before a point that something else hides [m]

/**
 * Everything that belongs to one mesh of the server: cloths, objects, and the playback of frames.
 */
export class WorldView {
  readonly playback: Playback;
  private cloth: ClothMesh; // as it is drawn now
  private cloths: { smooth: ClothMesh; quick: ClothMesh };
  private objects: Objects;
  private drawn_circle: FabricCircle | null = null;

  constructor(
    readonly announcement: MeshAnnouncement,
    private data: MeshData,
    private stage: Stage,
  ) {
    this.playback = new Playback(announcement.vertices);
    this.playback.positions.set(data.restPositions);
    const thickness = Math.max(0, ...announcement.cloths.map((cloth) => cloth.thickness));
    this.objects = new Objects(announcement.colliders, data, thickness);
    const room = this.objects.room.bind(this.objects);
    const cloth = (quick: boolean) => new ClothMesh(announcement.cloths, data, quick, room);
    const smooth = cloth(stage.simple);
    const drafts = stage.drafts && levels_of(data, true) < levels_of(data, false);
    this.cloths = { smooth, quick: drafts ? cloth(true) : smooth };
    this.cloth = smooth;
    stage.scene.add(smooth.group, this.objects.group);
    stage.set_floor(this.objects.ground);
    stage.light(this.bounds());
  }

  get triangles(): Uint32Array {
    return this.cloth.triangles;
  }

  /** Circles in the fabric of the cloths. */
  get circle(): FabricCircle {
    this.drawn_circle ??= new FabricCircle(this.data.restPositions, this.triangles);
    return this.drawn_circle;
  }

  /** Whether cloth or an object is between two points [m], with some room before the second. */
  hides(eye: Vec3, point: Vec3): boolean {
    const way = point.map((value, axis) => value - eye[axis]);
    const length = Math.hypot(...way);
    const direction = way.map((value) => value / length) as Vec3;
    const cloth = cast_ray(eye, direction, this.playback.positions, this.triangles);
    const nearest = Math.min(cloth?.distance ?? Infinity, this.objects.distance(eye, direction));
    return nearest < length - CLEARANCE;
  }

  push(frame: Frame, now: number): void {
    this.playback.push(frame, now);
  }

  /** Advances the picture to a time [s, client's clock]; tells whether it changed. */
  show(now: number, live: boolean): boolean {
    const changed = this.playback.sample(now, live);
    if (changed) {
      this.objects.place(this.playback.poses);
      this.cloth.update(this.playback.positions);
      const ground = this.objects.ground_at(this.playback.poses);
      if (ground !== null) this.stage.raise_floor(ground);
    }
    return changed;
  }

  /**
   * Prepares what depends on where one looks from.
   * @param draft whether the picture is a draft, whose cloths are drawn quickly rather than smoothly
   */
  look_from(camera: Camera, draft: boolean): void {
    const { smooth, quick } = this.cloths;
    const cloth = draft ? quick : smooth;
    if (cloth !== this.cloth) {
      this.stage.scene.remove(this.cloth.group);
      this.stage.scene.add(cloth.group);
      this.cloth = cloth;
      cloth.update(this.playback.positions);
    }
    cloth.sort(camera);
  }

  /** Gives the cloths other looks. */
  dress(looks: (Look | undefined)[]): void {
    for (const cloth of new Set(Object.values(this.cloths))) cloth.dress(looks);
  }

  /** What is drawn of the world. */
  get parts(): { cloth: Group; objects: Group } {
    return { cloth: this.cloth.group, objects: this.objects.group };
  }

  /** The point where a ray meets the cloth, unless an object hides it. */
  hit(ray: { origin: Vec3; direction: Vec3 }): ClothHit | null {
    const { origin, direction } = ray;
    const hit = cast_ray(origin, direction, this.playback.positions, this.triangles);
    if (!hit || this.objects.distance(origin, direction) < hit.distance) return null;
    return hit;
  }

  object_poses(): ReturnType<Objects['poses']> {
    return this.objects.poses();
  }

  /** The object that a ray meets, unless the cloth hides it. */
  hit_object(ray: { origin: Vec3; direction: Vec3 }): ObjectHit | null {
    const { origin, direction } = ray;
    const hit = this.objects.hit(origin, direction);
    const cloth = hit && cast_ray(origin, direction, this.playback.positions, this.triangles);
    return cloth && cloth.distance < hit.distance ? null : hit;
  }

  /** The longest side of the box around the cloths [m]. */
  get cloth_extent(): number {
    const size = new Box3().setFromArray(this.playback.positions).getSize(new Vector3());
    return Math.max(size.x, size.y, size.z);
  }

  /** What a camera has to show. */
  subject(): Subject {
    const cloth = this.playback.positions;
    const { objects, triangles } = this;
    const start = this.data.restPositions;
    return { cloth, start, triangles, boxes: objects.boxes(), ground: objects.ground };
  }

  /** Bounds of the cloth and of the objects, with the ground below [m]. */
  bounds(): Box3 {
    const box = this.objects.bounds();
    const point = new Vector3();
    const { positions } = this.playback;
    for (let i = 0; i < positions.length; i += 3) box.expandByPoint(point.fromArray(positions, i));
    if (this.objects.ground !== null) box.min.y = Math.min(box.min.y, this.objects.ground);
    return box;
  }

  dispose(): void {
    for (const cloth of new Set(Object.values(this.cloths))) cloth.dispose();
    this.objects.dispose();
    this.stage.set_floor(null);
  }
}

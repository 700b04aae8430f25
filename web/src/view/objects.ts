import {
  Box3,
  BoxGeometry,
  BufferGeometry,
  CapsuleGeometry,
  Group,
  LineSegments,
  Matrix4,
  Mesh,
  Raycaster,
  SphereGeometry,
  Vector3,
} from 'three';
import { creased_geometry } from './creased.js';
import { inner_offset } from './normals.js';
import { ObjectLook } from './object_look.js';
import type { Collider, MeshData, PoseSample, Vec3 } from '../../../proto/js/messages.js';

/** The objects that cloth can touch, except the ground. */
export class Objects {
  readonly group = new Group();
  /** Height of the ground [m], or null if there is none. */
  readonly ground: number | null = null;
  private look = new ObjectLook();
  private caster = new Raycaster();
  private nodes: Node[] = [];
  private ground_place = -1;
  private ground_now: number | null = null;
  private point = new Vector3();

  /**
   * @param inset by which meshes are drawn thinner [m]. Contact keeps particles and edges outside,
   *      but the middle of a flat triangle of cloth may dip slightly below a curved surface.
   */
  constructor(colliders: Collider[], data: MeshData, inset: number) {
    for (const [place, collider] of colliders.entries()) {
      if (collider.kind === 'plane') {
        // A floor is drawn only for level ground.
        if (collider.normal[1] > 0.99) {
          this.ground = this.ground_now = collider.point[1];
          this.ground_place = place;
        }
        continue;
      }
      const geometry = geometry_of(collider, place, data, inset);
      geometry.computeBoundingBox();
      const mesh = new Mesh(geometry, this.look.material_of(collider));
      const edges = this.look.edges_of(collider, geometry);
      if (edges) mesh.add(edges);
      mesh.name = collider.name;
      mesh.castShadow = mesh.receiveShadow = true;
      place_object(mesh, collider);
      const pivot = new Vector3(...collider.pivot);
      mesh.position.sub(pivot);
      const holder = new Group().add(mesh);
      holder.position.copy(pivot);
      const radius = collider.kind === 'sphere' ? collider.radius : null;
      this.nodes.push({ place, pivot, holder, mesh, radius, to_own: new Matrix4() });
      this.group.add(holder);
    }
    this.update_matrices();
  }

  /** Moves objects to their poses; objects without one stand as defined. */
  place(poses: PoseSample[]): void {
    for (const { place, pivot, holder } of this.nodes) {
      const pose = poses.find(({ collider }) => collider === place);
      if (pose) {
        holder.position.fromArray(pose.position);
        holder.quaternion.fromArray(pose.rotation);
      } else {
        holder.position.copy(pivot);
        holder.quaternion.identity();
      }
    }
    this.update_matrices();
    this.ground_now = this.ground_at(poses);
  }

  private update_matrices(): void {
    this.group.updateMatrixWorld(true);
    for (const { mesh, to_own } of this.nodes) to_own.copy(mesh.matrixWorld).invert();
  }

  /** Poses of the drawn objects. */
  poses(): { place: number; name: string; position: number[]; rotation: number[] }[] {
    return this.nodes.map(({ place, holder }) => ({
      place,
      name: holder.children[0].name,
      position: holder.position.toArray(),
      rotation: holder.quaternion.toArray(),
    }));
  }

  /** Height of the ground with these poses. */
  ground_at(poses: PoseSample[]): number | null {
    const pose = poses.find(({ collider }) => collider === this.ground_place);
    return pose ? pose.position[1] : this.ground;
  }

  /** Bounds of all objects [m]. */
  bounds(): Box3 {
    return new Box3().setFromObject(this.group);
  }

  /** Around each object [m]. */
  boxes(): Box3[] {
    return this.group.children.map((child) => new Box3().setFromObject(child));
  }

  /** How far at least the nearest object is from a place; 0 within the box around a capsule or mesh [m]. */
  room([x, y, z]: Vec3): number {
    let nearest = this.ground_now === null ? Infinity : y - this.ground_now;
    for (const { mesh, radius, to_own } of this.nodes) {
      this.point.set(x, y, z).applyMatrix4(to_own);
      const box = mesh.geometry.boundingBox!;
      nearest = Math.min(nearest, radius === null ? box.distanceToPoint(this.point) : this.point.length() - radius);
    }
    return Math.max(0, nearest);
  }

  /** Distance to the first object along a ray [m]; Infinity if it meets none. */
  distance(origin: Vec3, direction: Vec3): number {
    return this.hit(origin, direction)?.distance ?? Infinity;
  }

  /** The first object along a ray, as drawn. */
  hit(origin: Vec3, direction: Vec3): ObjectHit | null {
    this.caster.set(new Vector3(...origin), new Vector3(...direction));
    const met = this.caster.intersectObjects(this.group.children, true)[0];
    if (!met) return null;
    const node = this.nodes.find(({ holder }) => holder === met.object.parent);
    return {
      place: node?.place ?? -1,
      name: met.object.name,
      distance: met.distance,
      position: met.point.toArray(),
      pivot: met.object.parent!.position.toArray(),
    };
  }

  dispose(): void {
    this.group.removeFromParent();
    this.group.traverse((child) => {
      if (child instanceof Mesh || child instanceof LineSegments) child.geometry.dispose();
    });
    this.look.dispose();
  }
}

export interface ObjectHit {
  /** Index in the list of colliders. */
  place: number;
  name: string;
  /** From the ray's origin [m]. */
  distance: number;
  position: Vec3;
  /** Where the object's pivot is now [m]. */
  pivot: Vec3;
}

/** An object with its index in the list of colliders; the holder is at its pivot. */
interface Node {
  place: number;
  pivot: Vector3;
  holder: Group;
  mesh: Mesh;
  radius: number | null; // of a sphere [m]
  to_own: Matrix4; // from the world into the mesh's own frame
}

function geometry_of(
  collider: Collider,
  place: number,
  data: MeshData,
  inset: number,
): BufferGeometry {
  switch (collider.kind) {
    case 'sphere':
      return new SphereGeometry(collider.radius, 64, 40);
    case 'capsule': {
      const length = new Vector3(...collider.a).distanceTo(new Vector3(...collider.b));
      return new CapsuleGeometry(collider.radius, length, 12, 32);
    }
    case 'box': {
      const [x, y, z] = collider.half_extents;
      return new BoxGeometry(2 * x, 2 * y, 2 * z);
    }
    default: {
      const mesh = data.colliders.find((each) => each.collider === place);
      if (!mesh) return new BufferGeometry();
      return creased_geometry(inner_offset(mesh.positions, mesh.triangles, inset), mesh.triangles);
    }
  }
}

function place_object(mesh: Mesh, collider: Collider): void {
  if (collider.kind === 'sphere' || collider.kind === 'box') mesh.position.set(...collider.center);
  if (collider.kind === 'box') mesh.quaternion.set(...collider.orientation);
  if (collider.kind !== 'capsule') return;
  const a = new Vector3(...collider.a);
  const axis = new Vector3(...collider.b).sub(a);
  mesh.position.copy(a).addScaledVector(axis, 0.5);
  mesh.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), axis.normalize());
}

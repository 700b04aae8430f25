import { PerspectiveCamera, Vector2, Vector3 } from 'three';
import type { Vec3 } from '../../../proto/js/messages.js';
import type { Pose, Window } from './framing.js';

const FIELD_OF_VIEW = 32; // vertical [degrees]
const SMOOTHING_TIME = 0.07; // in which the rest of a movement by hand decays to 1/e [s]
const LED_SMOOTHING_TIME = 0.35; // of a movement without a hand [s]
const NEAREST = 0.1; // [m]
const FARTHEST = 30; // [m]
const LEAST_HEIGHT = 0.04; // above the ground [m]
const HIGHEST_ELEVATION = 1.5; // [rad]

function copy_pose(pose: Pose): Pose {
  return { ...pose, target: pose.target.clone() };
}

/** Orbits around a target; approaches the requested pose smoothly. */
export class OrbitCamera {
  readonly camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 60);
  private wanted: Pose = {
    target: new Vector3(0, 0.9, 0),
    distance: 4,
    azimuth: -0.58,
    elevation: 0.2,
  };
  private present = copy_pose(this.wanted);
  private smoothing = SMOOTHING_TIME;

  /** @param azimuth, elevation changes [rad] */
  orbit(azimuth: number, elevation: number): void {
    this.wanted.azimuth += azimuth;
    this.wanted.elevation += elevation;
    this.moved_by_hand();
  }

  /** Moves points in the target's plane with the pointer; dx, dy in heights of the view. */
  pan(dx: number, dy: number): void {
    const height = 2 * this.wanted.distance * Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    const right = new Vector3().setFromMatrixColumn(this.camera.matrix, 0);
    const up = new Vector3().setFromMatrixColumn(this.camera.matrix, 1);
    this.wanted.target.addScaledVector(right, -dx * height).addScaledVector(up, dy * height);
    this.wanted.target.clampScalar(-FARTHEST, FARTHEST);
    this.moved_by_hand();
  }

  /** @param factor of the distance */
  zoom(factor: number): void {
    this.wanted.distance *= factor;
    this.moved_by_hand();
  }

  /** Goes to a pose, at once or smoothly. */
  look(pose: Pose, at_once: boolean): void {
    // The shorter way round.
    const turns = Math.round((this.wanted.azimuth - pose.azimuth) / (2 * Math.PI));
    this.wanted = { ...copy_pose(pose), azimuth: pose.azimuth + 2 * Math.PI * turns };
    this.smoothing = LED_SMOOTHING_TIME;
    this.limit();
    if (at_once) this.present = copy_pose(this.wanted);
  }

  /** Where the camera is going. */
  get heading(): Pose {
    return copy_pose(this.wanted);
  }

  /** Its opening, where panels cover these parts of the picture's height. */
  window(covered: Pick<Window, 'above' | 'below' | 'corners'>): Window {
    const slope = Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    return { slope, aspect: this.camera.aspect, ...covered };
  }

  resize(width: number, height: number): void {
    this.camera.aspect = width / Math.max(1, height);
    this.camera.updateProjectionMatrix();
  }

  /** Advances by a time [s]; tells whether the view changed. */
  update(elapsed: number): boolean {
    const before = this.camera.matrixWorld.clone();
    const part = 1 - Math.exp(-elapsed / this.smoothing);
    const { present, wanted } = this;
    const approach = (from: number, to: number) =>
      Math.abs(to - from) < 1e-5 ? to : from + (to - from) * part;
    present.azimuth = approach(present.azimuth, wanted.azimuth);
    present.elevation = approach(present.elevation, wanted.elevation);
    present.distance = approach(present.distance, wanted.distance);
    present.target.set(
      approach(present.target.x, wanted.target.x),
      approach(present.target.y, wanted.target.y),
      approach(present.target.z, wanted.target.z),
    );
    this.place();
    return !before.equals(this.camera.matrixWorld);
  }

  /** Origin and direction [m, unit] of the ray through a point of the view. */
  ray(ndc: Vector2): { origin: Vec3; direction: Vec3 } {
    const point = new Vector3(ndc.x, ndc.y, 0.5).unproject(this.camera);
    const direction = point.sub(this.camera.position).normalize();
    return { origin: this.camera.position.toArray(), direction: direction.toArray() };
  }

  /** Distance of a point along the view [m]. */
  depth(point: Vec3): number {
    const forward = this.camera.getWorldDirection(new Vector3());
    return new Vector3(...point).sub(this.camera.position).dot(forward);
  }

  /** The point at a place of the view, at this distance along the view [m]. */
  point_at(ndc: Vector2, depth: number): Vec3 {
    const { origin, direction } = this.ray(ndc);
    const along = new Vector3(...direction).dot(this.camera.getWorldDirection(new Vector3()));
    const length = depth / Math.max(0.1, along);
    return [0, 1, 2].map((axis) => origin[axis] + direction[axis] * length) as Vec3;
  }

  /** The camera in the fields of the wire. */
  description(): { position: Vec3; target: Vec3; fov: number } {
    return {
      position: this.camera.position.toArray(),
      target: this.present.target.toArray(),
      fov: FIELD_OF_VIEW,
    };
  }

  private moved_by_hand(): void {
    this.smoothing = SMOOTHING_TIME;
    this.limit();
  }

  private limit(): void {
    const { wanted } = this;
    wanted.distance = Math.min(FARTHEST, Math.max(NEAREST, wanted.distance));
    wanted.target.y = Math.max(-1, wanted.target.y);
    const sine = (LEAST_HEIGHT - wanted.target.y) / wanted.distance;
    const lowest = Math.asin(Math.min(1, Math.max(-1, sine)));
    wanted.elevation = Math.min(HIGHEST_ELEVATION, Math.max(lowest, wanted.elevation));
  }

  private place(): void {
    const { target, distance, azimuth, elevation } = this.present;
    const level = Math.cos(elevation) * distance;
    this.camera.position.set(
      target.x + Math.sin(azimuth) * level,
      target.y + Math.sin(elevation) * distance,
      target.z + Math.cos(azimuth) * level,
    );
    this.camera.lookAt(target);
    this.camera.updateMatrixWorld();
  }
}

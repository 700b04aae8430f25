import { PerspectiveCamera, Vector2, Vector3 } from 'three';
import type { Box3 } from 'three';
import type { Vec3 } from '../../../proto/js/messages.js';

const FIELD_OF_VIEW = 32; // vertical [degrees]
const SMOOTHING_TIME = 0.07; // in which the rest of a movement decays to 1/e [s]
const NEAREST = 0.15; // [m]
const FARTHEST = 30; // [m]
const LEAST_HEIGHT = 0.04; // above the ground [m]
const HIGHEST_ELEVATION = 1.5; // [rad]

const FRAME_MARGIN = 1.05; // ratio of the view to a framed box

interface Pose {
  target: Vector3;
  distance: number;
  azimuth: number; // from +z towards +x [rad]
  elevation: number; // above the horizon [rad]
}

function copy_pose(pose: Pose): Pose {
  return { ...pose, target: pose.target.clone() };
}

/** Unit vectors to the viewer's right, up and back. */
function axes_of({ azimuth, elevation }: Pose) {
  const level = Math.cos(elevation);
  const back = new Vector3(Math.sin(azimuth) * level, Math.sin(elevation), Math.cos(azimuth) * level);
  const right = new Vector3(Math.cos(azimuth), 0, -Math.sin(azimuth));
  return { right, up: back.clone().cross(right), back };
}

function corners_of({ min, max }: Box3): Vector3[] {
  const pick = (bits: number, bit: number) => ((bits >> bit) & 1 ? max : min);
  return Array.from({ length: 8 }, (_, k) => new Vector3(pick(k, 0).x, pick(k, 1).y, pick(k, 2).z));
}

/** Orbits around a target; approaches the requested pose smoothly. */
export class OrbitCamera {
  readonly camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.02, 120);
  private wanted: Pose = {
    target: new Vector3(0, 0.9, 0),
    distance: 4,
    azimuth: -0.58,
    elevation: 0.2,
  };
  private present = copy_pose(this.wanted);

  /** @param azimuth, elevation changes [rad] */
  orbit(azimuth: number, elevation: number): void {
    this.wanted.azimuth += azimuth;
    this.wanted.elevation += elevation;
    this.limit();
  }

  /** Moves points in the target's plane with the pointer; dx, dy in heights of the view. */
  pan(dx: number, dy: number): void {
    const height = 2 * this.wanted.distance * Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    const right = new Vector3().setFromMatrixColumn(this.camera.matrix, 0);
    const up = new Vector3().setFromMatrixColumn(this.camera.matrix, 1);
    this.wanted.target.addScaledVector(right, -dx * height).addScaledVector(up, dy * height);
    this.wanted.target.clampScalar(-FARTHEST, FARTHEST);
    this.limit();
  }

  /** @param factor of the distance */
  zoom(factor: number): void {
    this.wanted.distance = Math.min(FARTHEST, Math.max(NEAREST, this.wanted.distance * factor));
    this.limit();
  }

  /**
   * Frames a box: as near as possible with all of its corners in view.
   * @param covered fractions of the view's height that panels cover at its ends
   */
  frame(box: Box3, covered: { above: number; below: number }, at_once: boolean): void {
    const { wanted } = this;
    const up_slope = Math.tan((FIELD_OF_VIEW * Math.PI) / 360) / FRAME_MARGIN;
    const side_slope = up_slope * this.camera.aspect;
    const [lowest, highest] = [2 * covered.below - 1, 1 - 2 * covered.above];
    const { right, up, back } = axes_of(wanted);
    const center = box.getCenter(new Vector3());
    // From a distance d, a corner at a right, b up and c back of the centre is in view if
    // |a| <= side_slope (d - c) and lowest <= (b - shift) / up_slope (d - c) <= highest.
    let across = 0;
    let least = Infinity;
    let most = -Infinity;
    for (const corner of corners_of(box)) {
      corner.sub(center);
      const [a, b, c] = [corner.dot(right), corner.dot(up), corner.dot(back)];
      across = Math.max(across, Math.abs(a) / side_slope + c);
      least = Math.min(least, b + lowest * up_slope * c);
      most = Math.max(most, b + highest * up_slope * c);
    }
    const along = (most - least) / ((highest - lowest) * up_slope);
    wanted.distance = Math.min(FARTHEST, Math.max(NEAREST, across, along));
    const shift = (most + least - (highest + lowest) * up_slope * wanted.distance) / 2;
    wanted.target.copy(center).addScaledVector(up, shift);
    this.limit();
    if (at_once) this.present = copy_pose(wanted);
  }

  resize(width: number, height: number): void {
    this.camera.aspect = width / Math.max(1, height);
    this.camera.updateProjectionMatrix();
  }

  /** Advances by a time [s]; tells whether the view changed. */
  update(elapsed: number): boolean {
    const before = this.camera.matrixWorld.clone();
    const part = 1 - Math.exp(-elapsed / SMOOTHING_TIME);
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

  private limit(): void {
    const { wanted } = this;
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

import { Vector3 } from 'three';
import type { Vec3, View } from '../../../proto/js/messages.js';

const HALVINGS = 16; // of where a picture's middle may be: then it is within a thousandth

/** Where an orbiting camera stands: it looks at a target, from a distance [m] and two angles [rad]. */
export interface Pose {
  target: Vector3;
  distance: number;
  /** From +z towards +x. */
  azimuth: number;
  /** Above the horizon. */
  elevation: number;
}

/** The opening of the camera, and the fractions of the picture's height that panels cover. */
export interface Window {
  /** Tangent of half the vertical angle of view. */
  slope: number;
  /** Width of the picture per height. */
  aspect: number;
  above: number;
  below: number;
  /** Panels beside the middle, in the upper corners. */
  corners?: Corner[];
}

/** A panel at the upper edge, in fractions of the picture's width and height. */
export interface Corner {
  left: number;
  right: number;
  bottom: number;
}

/** Unit vectors to the viewer's right, up and back. */
export function axes_of({ azimuth, elevation }: { azimuth: number; elevation: number }) {
  const level = Math.cos(elevation);
  const back = new Vector3(Math.sin(azimuth) * level, Math.sin(elevation), Math.cos(azimuth) * level);
  const right = new Vector3(Math.cos(azimuth), 0, -Math.sin(azimuth));
  return { right, up: back.clone().cross(right), back };
}

/** Azimuth and elevation of a direction towards the eye [rad]. */
function angles_of([x, y, z]: Vec3): { azimuth: number; elevation: number } {
  return { azimuth: Math.atan2(x, z), elevation: Math.atan2(y, Math.hypot(x, z)) };
}

/** Where a camera of the wire stands. */
export function pose_of_camera({ position, target }: { position: Vec3; target: Vec3 }): Pose {
  const back = position.map((x, axis) => x - target[axis]) as Vec3;
  return { target: new Vector3(...target), distance: Math.hypot(...back), ...angles_of(back) };
}

/** The nearest pose from this side that has all points in the middle of the free picture; `points` are xyz [m]. */
export function pose_around(
  points: ArrayLike<number>,
  side: { azimuth: number; elevation: number },
  { slope, aspect, above, below }: Window,
): Pose {
  const [lowest, highest] = [2 * below - 1, 1 - 2 * above];
  const { right, up, back } = axes_of(side);
  const [x, y, z] = [0, 1, 2].map((axis) => middle(points, axis));
  // Of each point: how far right, up and back of the middle it is.
  const places = [right, up, back].map(() => new Float64Array(points.length / 3));
  const point = new Vector3();
  for (let i = 0; i < points.length; i += 3) {
    point.set(points[i] - x, points[i + 1] - y, points[i + 2] - z);
    for (const [k, axis] of [right, up, back].entries()) places[k][i / 3] = point.dot(axis);
  }
  const [a, b, c] = places;
  const [wide, low, high] = [aspect * slope, lowest * slope, highest * slope];
  const distance = Math.max(least_distance(a, c, -wide, wide), least_distance(b, c, low, high));
  const slide = centred(a, c, distance, -wide, wide);
  const shift = centred(b, c, distance, low, high);
  const target = new Vector3(x, y, z).addScaledVector(right, slide).addScaledVector(up, shift);
  return { target, distance, azimuth: side.azimuth, elevation: side.elevation };
}

/**
 * From a distance d and shifted by s, a point at b across the view and c back of its middle is seen at
 * (b - s) / (d - c). This is the least distance from which, with some shift, all are seen from `low` to
 * `high`: tangents of angles.
 */
function least_distance(b: Float64Array, c: Float64Array, low: number, high: number): number {
  let [least, most] = [Infinity, -Infinity];
  for (let i = 0; i < b.length; i++) {
    least = Math.min(least, b[i] + low * c[i]);
    most = Math.max(most, b[i] + high * c[i]);
  }
  return (most - least) / (high - low);
}

/** The shift with which as much is free above the points as below them, by halving what is possible. */
function centred(b: Float64Array, c: Float64Array, distance: number, low: number, high: number): number {
  let [least, most] = [-Infinity, Infinity];
  for (let i = 0; i < b.length; i++) {
    least = Math.max(least, b[i] - high * (distance - c[i]));
    most = Math.min(most, b[i] - low * (distance - c[i]));
  }
  for (let halving = 0; halving < HALVINGS; halving++) {
    const shift = (least + most) / 2;
    let [lowest, highest] = [Infinity, -Infinity];
    for (let i = 0; i < b.length; i++) {
      const seen = (b[i] - shift) / (distance - c[i]);
      lowest = Math.min(lowest, seen);
      highest = Math.max(highest, seen);
    }
    if (lowest + highest > low + high) least = shift;
    else most = shift;
  }
  return (least + most) / 2;
}

/** The pose of a view: its sphere fills the free part of the picture. */
export function pose_of_view(view: View, { slope, aspect, above, below }: Window): Pose {
  const side = angles_of(view.direction);
  const opening = Math.min(slope * (1 - above - below), slope * aspect);
  const distance = (view.radius * Math.hypot(1, opening)) / opening;
  const shift = (above - below) * slope * distance;
  const target = new Vector3(...view.target).addScaledVector(axes_of(side).up, shift);
  return { target, distance, ...side };
}

/** Where points are seen, x and y of each from -1 to 1 in the picture; not a number behind the eye. */
function seen(points: ArrayLike<number>, pose: Pose, { slope, aspect }: Window): Float64Array {
  const { right, up, back } = axes_of(pose);
  const places = new Float64Array((points.length / 3) * 2);
  const point = new Vector3();
  for (let i = 0, k = 0; i < points.length; i += 3) {
    point.set(points[i], points[i + 1], points[i + 2]).sub(pose.target);
    const depth = pose.distance - point.dot(back);
    const reach = depth > 0 ? slope * depth : NaN;
    places[k++] = point.dot(right) / reach / aspect;
    places[k++] = point.dot(up) / reach;
  }
  return places;
}

/** Part of the points that are outside of the free picture, 0 to 1. */
export function part_outside(points: ArrayLike<number>, pose: Pose, window: Window): number {
  const places = seen(points, pose, window);
  let outside = 0;
  for (let k = 0; k < places.length; k += 2) {
    const y = places[k + 1];
    if (!(Math.abs(places[k]) <= 1 && y >= 2 * window.below - 1 && y <= 1 - 2 * window.above)) outside += 2;
  }
  return outside / Math.max(2, places.length);
}

/** Area of triangles in the picture, per that of the picture; what lies behind others counts too. */
export function part_covered(points: ArrayLike<number>, triangles: ArrayLike<number>, pose: Pose, window: Window): number {
  const places = seen(points, pose, window);
  let doubled = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => triangles[t + k] * 2);
    const across = (places[b] - places[a]) * (places[c + 1] - places[a + 1]);
    doubled += Math.abs(across - (places[b + 1] - places[a + 1]) * (places[c] - places[a]));
  }
  return doubled / 8;
}

/** How far down panels in corners reach that some of the points are behind; 0 if there are none. */
export function reach_of_corners(points: ArrayLike<number>, pose: Pose, window: Window): number {
  const places = seen(points, pose, window);
  let lowest = 0;
  for (let k = 0; k < places.length; k += 2) {
    const [x, y] = [(1 + places[k]) / 2, (1 - places[k + 1]) / 2];
    for (const { left, right, bottom } of window.corners ?? []) {
      if (x > left && x < right && y < bottom) lowest = Math.max(lowest, bottom);
    }
  }
  return lowest;
}

function middle(points: ArrayLike<number>, axis: number): number {
  let [least, most] = [Infinity, -Infinity];
  for (let i = axis; i < points.length; i += 3) {
    least = Math.min(least, points[i]);
    most = Math.max(most, points[i]);
  }
  return (least + most) / 2;
}

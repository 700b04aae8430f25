import { Vector3 } from 'three';
import type { Vec3, View } from '../../../proto/js/messages.js';

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

/** The nearest pose from this side that has all points in the free picture; `points` are xyz [m]. */
export function pose_around(
  points: ArrayLike<number>,
  side: { azimuth: number; elevation: number },
  { slope, aspect, above, below }: Window,
): Pose {
  const [lowest, highest] = [2 * below - 1, 1 - 2 * above];
  const { right, up, back } = axes_of(side);
  const [x, y, z] = [0, 1, 2].map((axis) => middle(points, axis));
  // From a distance d, a point at a right, b up and c back of the middle is in view if
  // |a - slide| <= aspect slope (d - c) and lowest <= (b - shift) / slope / (d - c) <= highest.
  const across = { least: Infinity, most: -Infinity };
  const along = { least: Infinity, most: -Infinity };
  const point = new Vector3();
  for (let i = 0; i < points.length; i += 3) {
    point.set(points[i] - x, points[i + 1] - y, points[i + 2] - z);
    const [a, b, c] = [point.dot(right), point.dot(up), point.dot(back)];
    across.least = Math.min(across.least, a - aspect * slope * c);
    across.most = Math.max(across.most, a + aspect * slope * c);
    along.least = Math.min(along.least, b + lowest * slope * c);
    along.most = Math.max(along.most, b + highest * slope * c);
  }
  const distance = Math.max(
    (across.most - across.least) / (2 * aspect * slope),
    (along.most - along.least) / ((highest - lowest) * slope),
  );
  const slide = (across.most + across.least) / 2;
  const shift = (along.most + along.least - (highest + lowest) * slope * distance) / 2;
  const target = new Vector3(x, y, z).addScaledVector(right, slide).addScaledVector(up, shift);
  return { target, distance, azimuth: side.azimuth, elevation: side.elevation };
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

/** Part of the points that are outside of the free picture, 0 to 1. */
export function part_outside(points: ArrayLike<number>, pose: Pose, window: Window): number {
  const { slope, aspect, above, below } = window;
  const { right, up, back } = axes_of(pose);
  const point = new Vector3();
  let outside = 0;
  for (let i = 0; i < points.length; i += 3) {
    point.set(points[i], points[i + 1], points[i + 2]).sub(pose.target);
    const reach = slope * (pose.distance - point.dot(back));
    const [across, along] = [point.dot(right) / reach / aspect, point.dot(up) / reach];
    const inside = reach > 0 && Math.abs(across) <= 1 && along >= 2 * below - 1 && along <= 1 - 2 * above;
    if (!inside) outside += 1;
  }
  return (outside * 3) / Math.max(3, points.length);
}

function middle(points: ArrayLike<number>, axis: number): number {
  let [least, most] = [Infinity, -Infinity];
  for (let i = axis; i < points.length; i += 3) {
    least = Math.min(least, points[i]);
    most = Math.max(most, points[i]);
  }
  return (least + most) / 2;
}

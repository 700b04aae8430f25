import { Box3, Vector3 } from 'three';
import type { View } from '../../../proto/js/messages.js';
import type { OrbitCamera } from './camera.js';
import { axes_of, part_covered, part_outside, pose_around, pose_of_view, reach_of_corners } from './framing.js';
import type { Pose, Window } from './framing.js';

const MARGIN = 1.06; // of the picture around what is framed
const MOST_OUTSIDE = 0.1; // part of the cloth that may leave the picture before the camera follows
const MOST_GONE = 0.25; // part of the cloth that has left a first view; else it is followed at once
const HOME_OUTSIDE = 0.02; // part outside of the first view at which the camera returns to it
const LEAST_FOLLOWED = 0.7; // of the first view's distance, however small the cloth gets
const MOST_APPROACH = 0.72; // of a view's distance, to a cloth that leaves room
const RETREAT = 1.16; // of a first view's distance, to have nothing behind a panel in a corner
const MOST_RETREAT = 1.5; // the same where much of the picture is cloth
const LARGE = 0.3; // part of the picture that is cloth after that, at least
const RETREAT_STEP = 0.04;
const MOST_SLIDE = 0.1; // of the picture's width, sideways to the same end
const SLIDE_STEP = 0.01;
const LOOK_INTERVAL = 0.2; // between two looks at whether the cloth is in the picture [s]
const NEAR_OBJECT = 0.15; // of the cloth's diagonal: so much of the objects around is framed too
const NEAR_GROUND = 0.35; // of the cloth's diagonal: so near the ground is framed too
const FRONT = -0.45; // preferred azimuth [rad]
const LEVEL = 0.24; // preferred elevation [rad]
const FRONT_WORTH = 0.35; // part of a side's score that the azimuth decides
const STEEP_COST = 0.9; // of the score, for each radian away from the preferred elevation
const AZIMUTHS = 24;
const ELEVATIONS = [0.1, 0.24, 0.4, 0.6, 0.9]; // [rad]

/** What there is to look at. */
export interface Subject {
  /** Of the cloths' vertices, xyz [m], now and at the scene's start. */
  cloth: ArrayLike<number>;
  start: ArrayLike<number>;
  triangles: ArrayLike<number>;
  /** Around the objects. */
  boxes: Box3[];
  /** Height of the ground [m], if there is any. */
  ground: number | null;
}

/** Looks after the camera until the viewer does: at a scene's first view, and where the cloth goes. */
export class Director {
  private home: Pose | null = null;
  private away = false;

  private tolerated = MOST_OUTSIDE; // more of the cloth, if the first view leaves more out
  private looked_at = 0; // [s]

  /** @param window tells the present free part of the picture */
  constructor(
    private orbit: OrbitCamera,
    private window: () => Window,
  ) {}

  /** Shows a scene as one sees it first, from its own view if it has one, and follows it from there. */
  begin(subject: Subject, view: View | null, at_once: boolean): void {
    const { cloth } = subject;
    const window = this.window();
    const first = first_look(subject, view, window);
    this.home = beside_corners(subject, first.home, window);
    this.away = first.away;
    const outside = part_outside(cloth, this.home, window);
    this.tolerated = this.away ? MOST_OUTSIDE : Math.max(MOST_OUTSIDE, 1.5 * outside);
    this.orbit.look(this.away ? pose_after(cloth, this.home, window) : this.home, at_once);
  }

  /** The viewer has moved the camera, and keeps it. */
  leave(): void {
    this.home = null;
  }

  /** Keeps the cloth in the picture. @param now [s] */
  follow(cloth: ArrayLike<number>, now: number): void {
    const { home } = this;
    if (!home || now - this.looked_at < LOOK_INTERVAL) return;
    this.looked_at = now;
    const window = this.window();
    if (this.away && part_outside(cloth, home, window) < HOME_OUTSIDE) {
      this.away = false;
      this.orbit.look(home, false);
    }
    const most = this.away ? MOST_OUTSIDE : this.tolerated;
    if (part_outside(cloth, this.orbit.heading, window) <= most) return;
    this.away = true;
    this.orbit.look(pose_after(cloth, home, window), false);
  }
}

/** A scene's first view, and whether its cloth has left that already. */
function first_look(subject: Subject, view: View | null, window: Window): { home: Pose; away: boolean } {
  const { cloth, start } = subject;
  const whole = view ? pose_of_view(view, window) : framed(subject, window);
  const away = part_outside(cloth, whole, window) - part_outside(start, whole, window) > MOST_GONE;
  return { home: view && !away ? approached(whole, cloth, window) : whole, away };
}

/** The view a little farther or moved sideways, by as little as puts no cloth behind a panel in a corner, if any does. */
function beside_corners({ cloth, triangles }: Subject, home: Pose, window: Window): Pose {
  const { right } = axes_of(home);
  const width = 2 * window.slope * window.aspect * home.distance;
  const outside = part_outside(cloth, home, window);
  const large = Math.sqrt(part_covered(cloth, triangles, home, window) / LARGE);
  const farthest = Math.max(RETREAT, Math.min(MOST_RETREAT, large));
  for (let farther = 1; farther <= farthest; farther += RETREAT_STEP) {
    for (let slide = 0; slide <= MOST_SLIDE; slide += SLIDE_STEP) {
      for (const way of [-slide, slide]) {
        const target = home.target.clone().addScaledVector(right, way * width);
        const pose = { ...home, target, distance: home.distance * farther };
        if (reach_of_corners(cloth, pose, window) <= window.above && part_outside(cloth, pose, window) <= outside) return pose;
      }
    }
  }
  return home;
}

/** Where a cloth is seen that has left its first view, from the same side. */
function pose_after(cloth: ArrayLike<number>, home: Pose, window: Window): Pose {
  const pose = pose_around(cloth, home, narrowed(window));
  return { ...pose, distance: Math.max(pose.distance, LEAST_FOLLOWED * home.distance) };
}

function framed({ cloth, triangles, boxes, ground }: Subject, window: Window): Pose {
  const points = [...Array.from(cloth), ...surroundings(cloth, boxes, ground)];
  return pose_around(points, best_side(cloth, triangles), narrowed(window));
}

/** A view that leaves room around the cloth, as when it has fallen since its start, comes nearer. */
function approached(home: Pose, cloth: ArrayLike<number>, window: Window): Pose {
  const close = pose_around(cloth, home, narrowed(window));
  if (close.distance >= home.distance) return fitted(home, close, window);
  const part = Math.min(1, (1 - MOST_APPROACH) / (1 - close.distance / home.distance));
  const distance = home.distance + (close.distance - home.distance) * part;
  return { ...home, distance, target: home.target.clone().lerp(close.target, part) };
}

/** On an upright screen, where a view's sphere fills the width, a wider cloth is to be seen too. */
function fitted(home: Pose, close: Pose, { aspect }: Window): Pose {
  return aspect < 1 ? close : home;
}

/** Corners of what is near the cloth: parts of objects, and the ground. */
function surroundings(cloth: ArrayLike<number>, boxes: Box3[], ground: number | null): number[] {
  const near = new Box3().setFromArray(cloth as number[]);
  const size = near.getSize(new Vector3()).length();
  const { x, z } = near.getCenter(new Vector3());
  const points = ground !== null && near.min.y - ground < NEAR_GROUND * size ? [x, ground, z] : [];
  near.expandByScalar(NEAR_OBJECT * size);
  for (const box of boxes.filter((each) => each.intersectsBox(near))) {
    const { min, max } = box.clone().intersect(near);
    for (const px of [min.x, max.x])
      for (const py of [min.y, max.y]) for (const pz of [min.z, max.z]) points.push(px, py, pz);
  }
  return points;
}

/** A window with a margin inside of the given one. */
function narrowed({ slope, aspect, above, below }: Window): Window {
  return { slope: slope / MARGIN, aspect, above, below };
}

/** The side from which a cloth shows most of itself, rather the front than the back or the top. */
export function best_side(cloth: ArrayLike<number>, triangles: ArrayLike<number>) {
  const normals = area_normals(cloth, triangles);
  let best = { azimuth: FRONT, elevation: LEVEL };
  let most = 0;
  for (let k = 0; k < AZIMUTHS; k++) {
    const azimuth = FRONT + (2 * Math.PI * k) / AZIMUTHS;
    for (const elevation of ELEVATIONS) {
      const { back } = axes_of({ azimuth, elevation });
      let area = 0;
      for (let i = 0; i < normals.length; i += 3) {
        area += Math.abs(normals[i] * back.x + normals[i + 1] * back.y + normals[i + 2] * back.z);
      }
      const front = 1 - FRONT_WORTH * (1 - Math.cos(azimuth - FRONT));
      const level = Math.max(0, 1 - STEEP_COST * Math.abs(elevation - LEVEL));
      const score = area * front * level;
      if (score <= most * (1 + 1e-6)) continue;
      most = score;
      best = { azimuth, elevation };
    }
  }
  return best;
}

/** Normals of the triangles, as long as twice their area [m^2]. */
function area_normals(points: ArrayLike<number>, triangles: ArrayLike<number>): Float32Array {
  const normals = new Float32Array(triangles.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [triangles[t] * 3, triangles[t + 1] * 3, triangles[t + 2] * 3];
    const [ux, uy, uz] = [0, 1, 2].map((i) => points[b + i] - points[a + i]);
    const [vx, vy, vz] = [0, 1, 2].map((i) => points[c + i] - points[a + i]);
    normals[t] = uy * vz - uz * vy;
    normals[t + 1] = uz * vx - ux * vz;
    normals[t + 2] = ux * vy - uy * vx;
  }
  return normals;
}

/** The view that an address asks for: `?view=` with target, direction and radius, seven numbers. */
export function view_of_address(search: string): View | null {
  const asked = new URLSearchParams(search).get('view')?.split(',').map(Number) ?? [];
  if (asked.length !== 7 || !asked.every(Number.isFinite) || asked[6] <= 0) return null;
  const [tx, ty, tz, dx, dy, dz, radius] = asked;
  if (Math.hypot(dx, dy, dz) === 0) return null;
  return { target: [tx, ty, tz], direction: [dx, dy, dz], radius };
}

// Written by proto/generate.py from the descriptions in proto/messages. Do not edit.

import type { Vec3 } from './messages.js';

export interface Fan {
  /** centre of the disc that its air leaves [m]; 3 × ±10000 */
  position: Vec3;
  /** of the jet, any length but 0; 3 × ±10000 */
  direction: Vec3;
  /** in the core of the jet [m/s]; 0 to 50 */
  speed?: number;
  /** of the disc [m]; 0.01 to 10 */
  radius?: number;
  /** growth of the jet's radius per distance; 0 to 2 */
  spread?: number;
  /** length of the core [m]; 0.01 to 100 */
  reach?: number;
}

export interface Fabric {
  /** all values of this one; 1 to 64 bytes */
  preset?: string;
  /** mass per area [kg/m²]; 0.001 to 100 */
  areal_density?: number;
  /** stiffness along u [N/m]; 0 to 1 000 000 */
  stretch_warp?: number;
  /** stiffness along v [N/m]; 0 to 1 000 000 */
  stretch_weft?: number;
  /** stiffness [N/m]; 0 to 1 000 000 */
  shear?: number;
  /** of a mesh: narrowing along v per strain along u; -1: as on a grid; -1 to 100 */
  poisson?: number;
  /** rigidity along u [N m]; 0 to 10 */
  bending_warp?: number;
  /** rigidity along v [N m]; 0 to 10 */
  bending_weft?: number;
  /** from which a thread is stiffer; 0: none; 0 to 10 */
  locking_strain?: number;
  /** how many times as stiff it then is; 1 to 1000 */
  locking_factor?: number;
  /** of the highest mode of stretch; 0 to 1 */
  damping_ratio?: number;
  /** relaxation time [s]; 0 to 10 */
  stretch_damping?: number;
  /** relaxation time [s]; 0 to 10 */
  shear_damping?: number;
  /** relaxation time [s]; 0 to 10 */
  bending_damping?: number;
  /** distance from objects in contact [m]; 0.0001 to 0.1 */
  thickness?: number;
  /** Coulomb's coefficient; 0 to 10 */
  friction?: number;
  /** of the impact velocity; 0 to 0.999 */
  restitution?: number;
  /** drag coefficient across the wind; 0 to 100 */
  air_normal?: number;
  /** skin friction along the wind [kg/(m² s)]; 0 to 100 */
  air_tangential?: number;
}

export interface Camera {
  /** of the eye [m]; 3 × ±10000 */
  position: Vec3;
  /** what it looks at; not the same point [m]; 3 × ±10000 */
  target: Vec3;
  /** a direction; 3 × ±10000 */
  up?: Vec3;
  /** vertical angle of view [degrees]; 1 to 179 */
  fov?: number;
}

export interface Hit {
  /** to hold it at a point of this triangle; 0 to 2147483647 */
  triangle: number;
  /** of that point; sum 1 within 0.001; 3 × 0 to 1 */
  barycentric: Vec3;
  /** of the point [m] */
  position: Vec3;
  /** its nearest corner */
  particle: number;
  /** along the ray [m] */
  distance: number;
}

export interface RoomInfo {
  /** of the address `/ws/name` */
  name: string;
  /** its name */
  scene: string;
  /** of all cloths */
  particles: number;
  /** connected */
  viewers: number;
  /** of its present state */
  tick: number;
  /** whether it is; `true` or `false` */
  paused: boolean;
  /** simulated per real time; 0 while its time stands */
  real_time_factor: number;
}

export interface Sleeping {
  /** groups of touching cloths that sleep and wake together */
  islands: number;
  /** by name; no frames are sent while all of them rest */
  cloths: string[];
}

export interface Guarantee {
  /** whether the promise of no crossings holds; `held` or `bad_start` or `void` or `none` */
  state: 'held' | 'bad_start' | 'void' | 'none';
  /** `objects`, `cloth` or both */
  covers: string[];
  /** of features, without a promise */
  pairs: number;
  /** in words; none if the promise holds */
  reasons: string[];
}

export interface Crossings {
  /** edges of cloth that pass through something */
  count: number;
  /** of the count */
  tick: number;
  /** least contact distance then, negative inside an object; null: nothing is near [m] */
  smallest_gap: number | null;
}

export interface Strain {
  /** of an edge, relative */
  largest: number;
  /** which one edge in a hundred exceeds */
  p99: number;
}

export interface Energy {
  kinetic: number;
  /** of the membrane [J] */
  stretch: number;
  bending: number;
  /** above the height 0 [J] */
  gravity: number;
  total: number;
}

export interface EnergyWork {
  hands: number;
  slings: number;
  /** moving ones, and pins that stop what they take hold of [J] */
  pins: number;
  /** moving ones [J] */
  objects: number;
  /** their jaws [J] */
  grippers: number;
  /** force of the air times the speed of the air [J] */
  wind: number;
  /** contact: positions corrected without a velocity [J] */
  push_out: number;
  /** of the scene [J] */
  disturbances: number;
  /** other gravity, softness or fabric, pins that stop [J] */
  commands: number;
}

export interface EnergyLosses {
  /** of the fabric [J] */
  damping: number;
  /** of the scene [J] */
  drag: number;
  /** its resistance [J] */
  air: number;
  /** of objects [J] */
  friction: number;
  /** on objects [J] */
  impacts: number;
  /** of cloth with cloth, with friction [J] */
  self_contact: number;
  /** motion of cloth that fell asleep [J] */
  sleep: number;
  /** of cloth that was stopped, as it diverged [J] */
  recovery: number;
  /** what no cause explains; negative: brought by it [J] */
  solver: number;
}

export interface EnergyBalance {
  /** tick at whose end measuring began */
  since: number;
  /** total then [J] */
  start: number;
  /** of what acts on the cloth */
  work: EnergyWork;
  /** to what takes energy from it */
  losses: EnergyLosses;
  /** total [J] */
  now: number;
}

export interface PinForce {
  /** its id */
  pin: number;
  /** on the cloth [N] */
  force: Vec3;
}

export interface GrabForce {
  /** its number */
  grab: number;
  /** its owner */
  viewer: number;
  /** on the cloth [N] */
  force: Vec3;
}

export interface ColliderForce {
  /** its name */
  collider: string;
  /** of the cloth on it [N] */
  force: Vec3;
}

export interface Viewer {
  /** its number */
  id: number;
  name: string;
  /** `#rrggbb` */
  color: string;
  /** what it may do; `viewer` or `operator` or `admin` */
  role: 'viewer' | 'operator' | 'admin';
  /** whether it may hold the cloth; `true` or `false` */
  hand: boolean;
  /** where it looks from, as last told */
  camera: Camera | null;
}

export interface Presence {
  /** of which something is new */
  viewer: number;
  /** what it points at [m] */
  cursor?: Vec3;
  /** it points at nothing any more; `true` or `false` */
  away?: boolean;
  /** where it looks from; only while others see by it */
  camera?: Camera;
  /** by whose camera it sees now; 0: its own */
  follows?: number;
}

export interface Pin {
  id: number;
  /** its owner; 0: the scene */
  viewer: number;
  /** the centre of its disc */
  particle: number;
  /** of the disc [m] */
  radius: number;
  /** of its particle [m] */
  position: Vec3;
  /** particles that it holds */
  count: number;
  /** of a moving pin [m] */
  target?: Vec3;
  /** whether its particles lag behind; `true` or `false` */
  behind?: boolean;
}

export interface Grab {
  /** the room's number */
  id: number;
  /** its owner; 0: the scene */
  viewer: number;
  /** the owner's number */
  drag: number;
  /** to hold it at a point of this triangle; 0 to 2147483647 */
  triangle: number;
  /** of that point; sum 1 within 0.001; 3 × 0 to 1 */
  barycentric: Vec3;
  /** of the held disc [m] */
  radius: number;
  stiffness: number;
  max_force: number;
  /** the point of the cloth [m] */
  held: Vec3;
  /** where it is pulled to [m] */
  target: Vec3;
  mode: 'live' | 'sling';
  /** on the cloth; in answers to `query` [N] */
  force?: Vec3;
}

export interface StageWork {
  /** of the tick */
  stage: string;
  milliseconds: number;
  /** items done */
  work: number;
}

export interface Tree {
  /** its name */
  tree: string;
  /** of boxes */
  levels: number;
}

export interface ColliderPose {
  name: string;
  /** of the pivot [m] */
  position: Vec3;
  /** relative to the mesh message */
  rotation: number[];
  /** of the cloth on it while it moves [N] */
  force: Vec3;
  /** held back in the last tick; `true` or `false` */
  blocked: boolean;
  /** has moved on through cloth; `true` or `false` */
  voided: boolean;
}

export interface Contact {
  /** absent: the other side is cloth too */
  collider?: string;
  /** of the cloth */
  particles: number[];
  /** sum 1; negative on the other side */
  weights: number[];
  /** on the mid-surface [m] */
  point: Vec3;
  /** unit, out of the other side */
  normal: Vec3;
  /** from the mid-surface [m] */
  gap: number;
  /** on the cloth [N] */
  normal_force: number;
  /** on the cloth [N] */
  friction: Vec3;
}

export interface Reactions {
  /** absent if the solver does not know them */
  pins?: PinForce[];
  /** of hands */
  grabs: GrabForce[];
  colliders: ColliderForce[];
}

export interface GripperState {
  name: string;
  /** of its middle [m] */
  position: Vec3;
  /** from its definition */
  rotation: number[];
  /** between its jaws [m] */
  opening: number;
  /** most that each jaw presses with [N] */
  force: number;
  /** it presses something; `true` or `false` */
  gripping: boolean;
  /** of the cloth on both jaws [N] */
  reaction: Vec3;
  /** the same about its middle [N m] */
  torque: Vec3;
}

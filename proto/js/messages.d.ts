// Types of the messages of weft.v1. proto/README.md gives the meaning and unit of each field.

export type Vec3 = [number, number, number];
export type {
  Cloth,
  Collider,
  FabricName,
  Look,
  MeshAnnouncement,
  View,
} from './announcement.js';
export type QueryWhat =
  | 'positions'
  | 'velocities'
  | 'energies'
  | 'strain'
  | 'pins'
  | 'grabs'
  | 'camera'
  | 'roster'
  | 'state'
  | 'work'
  | 'trees'
  | 'boxes'
  | 'colliders'
  | 'measurements'
  | 'contacts'
  | 'reactions'
  | 'grippers'
  | 'crossings';

/** The frames of an `advance` that its viewer gets, regardless of its `hz`. */
export type AdvanceFrames = 'none' | 'last' | 'all';

/** A hierarchy of boxes. */
export interface Tree {
  tree: string;
  levels: number;
}

export interface Welcome {
  op: 'welcome';
  protocol: string;
  server: string;
  version: string;
  session: string;
  viewer: number;
  name: string;
  color: string;
  role: 'viewer' | 'operator' | 'admin';
  room: string;
  scene: string;
  tick_rate: number;
  clock: number;
  codecs: string[];
  limits: Record<string, number>;
  capabilities: string[];
}

export interface Energy {
  kinetic: number;
  stretch: number;
  bending: number;
  gravity: number;
  total: number;
}

export interface Strain {
  largest: number;
  p99: number;
}

/** A local wind. */
export interface Fan {
  position: Vec3;
  direction: Vec3;
  speed?: number;
  radius?: number;
  spread?: number;
  reach?: number;
}

/** The values of `set`. */
export interface Settings extends Environment {
  softness: number;
  budget_ms: number;
  over_budget: 'slow' | 'soften';
}

export interface Environment {
  gravity: Vec3;
  wind: Vec3;
  gust_speed: number;
  gust_length: number;
  air_density: number;
  still_air: boolean;
  drag: number;
  fans: Fan[];
}

/** Whether the promise that cloth crosses nothing holds. */
export interface Guarantee {
  state: 'held' | 'bad_start' | 'void' | 'none';
  covers: ('objects' | 'cloth')[];
  /** Number of feature pairs without a promise. */
  pairs: number;
  /** In words; none if the promise holds. */
  reasons: string[];
}

/** Intersections of cloths' edges and triangles, with each other and with objects. */
export interface Crossings {
  count: number;
  /** Tick of the count. */
  tick: number;
  /** Least contact distance then [m], negative inside an object; null if nothing is near. */
  smallest_gap: number | null;
}

export interface State extends Settings {
  op: 'state';
  tick: number;
  time: number;
  paused: boolean;
  speed: number;
  pace: number;
  scene: string;
  tick_rate: number;
  fabric: string;
  solver: string;
  substeps: number;
  particles: number;
  step_ms: number;
  real_time_factor: number;
  /** Cloths at rest, which are not stepped; no frames are sent while all of them rest. */
  sleeping: { islands: number; cloths: string[] };
  guarantee: Guarantee;
  /** As last counted; null before the first count. */
  crossings: Crossings | null;
  strain: Strain;
  energy: Energy;
}

export interface Camera {
  position: Vec3;
  target: Vec3;
  up: Vec3;
  fov: number;
}

export interface Viewer {
  id: number;
  name: string;
  color: string;
  role: string;
  camera: Camera | null;
}

export interface Roster {
  op: 'roster';
  viewers: Viewer[];
}

export interface Pin {
  id: number;
  viewer: number;
  particle: number;
  radius: number;
  position: Vec3;
  count: number;
  /** Target of a moving pin. */
  target?: Vec3;
  /** Whether its particles lag behind the target. */
  behind?: boolean;
}

export interface Pins {
  op: 'pins';
  tick: number;
  pins: Pin[];
}

export interface Grab {
  id: number;
  /** 0: the scene's own. */
  viewer: number;
  /** The viewer's number, or the index in the scene's list of hands. */
  drag: number;
  triangle: number;
  barycentric: Vec3;
  radius: number;
  stiffness: number;
  max_force: number;
  held: Vec3;
  target: Vec3;
  mode: 'live' | 'sling';
  force?: Vec3;
}

export interface Grabs {
  op: 'grabs';
  tick: number;
  grabs: Grab[];
}

export interface Notice {
  op: 'notice';
  level: 'info' | 'warning' | 'error';
  code: string;
  message: string;
  tick?: number;
  viewer?: number;
  drag?: number;
  count?: number;
  value?: number;
}

export interface Bye {
  op: 'bye';
  code: number;
  reason: string;
}

export interface Limit {
  minimum?: number;
  maximum?: number;
  length?: number;
  allowed?: string[];
}

export interface ErrorMessage {
  op: 'error';
  id?: number | string;
  command?: string;
  code: string;
  message: string;
  field?: string;
  value?: unknown;
  limit?: Limit;
  hint?: string;
}

export interface Result {
  op: 'result';
  id: number | string;
  command: string;
  tick?: number;
  [field: string]: any;
}

/** A point of the cloth, as returned by `pick`. */
export interface Hit {
  triangle: number;
  barycentric: Vec3;
  position: Vec3;
  particle: number;
  distance: number;
}

/** Where to hold: a point of a triangle, or a particle. */
export type Hold = { triangle: number; barycentric: Vec3 } | { particle: number };

export interface DragOptions {
  target?: Vec3;
  radius?: number;
  stiffness?: number;
  max_force?: number;
  /** A sling leaves the cloth alone until its release; then it gives its force for 0.1 s. */
  mode?: 'live' | 'sling';
}

/** A hand at the tick of a frame. */
export interface GrabSample {
  id: number;
  viewer: number;
  held: number[];
  target: number[];
  force: number;
}

export interface Frame {
  type: 'frame';
  flags: number;
  /** The state was replaced; do not interpolate to it. */
  jump: boolean;
  paused: boolean;
  tick: number;
  time: number;
  serverTime: number;
  sequence: number;
  reference: number;
  epoch: number;
  /** Three values per vertex [m]. */
  positions: Float32Array;
  grabs: GrabSample[];
  applied: { viewer: number; number: number }[];
  /** Colliders whose poses differ from the message `mesh`. */
  poses: PoseSample[];
  /** Of the cloth, if `view` asked for `forces`. */
  contacts: ContactSample[];
  /** Forces on the cloth's supports, if `view` asked for `forces`. */
  reactions: ReactionSample[];
}

export interface ContactSample {
  /** Index in `MeshAnnouncement.colliders`; null: the other side is cloth too. */
  collider: number | null;
  /** The cloth particle with the largest weight. */
  particle: number;
  /** On the cloth's mid-surface [m]. */
  point: number[];
  /** Unit, out of the other side. */
  normal: number[];
  /** From the mid-surface to the other side [m]. */
  gap: number;
  /** On the cloth, along the normal [N]. */
  normalForce: number;
  /** On the cloth, tangential [N]. */
  friction: number[];
}

export interface ReactionSample {
  /** A number, if this client does not know its meaning. */
  of: 'pin' | 'collider' | number;
  /** Of the pin, or the collider's index in `MeshAnnouncement.colliders`. */
  id: number;
  /** Of a pin on the cloth, of the cloth on a collider [N]. */
  force: number[];
}

/** A point p of the collider is at `position` + `rotation` (p - pivot). */
export interface PoseSample {
  /** Index in `MeshAnnouncement.colliders`. */
  collider: number;
  /** Of its pivot [m]. */
  position: number[];
  /** Unit quaternion x, y, z, w. */
  rotation: number[];
}

export interface ColliderMesh {
  /** Index in `MeshAnnouncement.colliders`. */
  collider: number;
  positions: Float32Array;
  triangles: Uint32Array;
}

export interface MeshData {
  type: 'mesh';
  restPositions: Float32Array;
  triangles: Uint32Array;
  /** Two values per vertex. */
  uv: Float32Array;
  /** Four values per vertex, of the codec `packed`; null if all cloths are grids. */
  order: Uint32Array | null;
  colliders: ColliderMesh[];
}

export interface Data {
  type: 'data';
  tick: number;
  transfer: number;
  components: number;
  values: Float32Array | Float64Array;
}

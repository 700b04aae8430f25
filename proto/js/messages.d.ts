// Types of the messages of weft.v1. proto/README.md gives the meaning and unit of each field.

import type { AdvanceCommand, DragCommand1, QueryCommand } from './commands.js';
import type { State } from './events.js';
import type {
  Camera,
  ColliderPose,
  Contact,
  Crossings,
  Energy,
  EnergyBalance,
  Grab,
  GripperState,
  Pin,
  Presence,
  Reactions,
  StageWork,
  Strain,
  Tree,
  Viewer,
} from './parts.js';
import type { Results } from './results.js';

export type Vec3 = [number, number, number];
export type {
  Cloth,
  Collider,
  FabricName,
  Look,
  MeshAnnouncement,
  View,
} from './announcement.js';
export type {
  Camera,
  ColliderPose,
  Contact,
  Crossings,
  Energy,
  EnergyBalance,
  Fabric,
  Fan,
  Grab,
  GripperState,
  Guarantee,
  Hit,
  Pin,
  Presence,
  Reactions,
  StageWork,
  Strain,
  Tree,
  Viewer,
} from './parts.js';
export type {
  AdvanceCommand,
  CameraCommand,
  GripperCommand,
  HelloCommand,
  SetCommand,
  ViewCommand,
} from './commands.js';
export type { Bye, Notice, State } from './events.js';
export type { Results } from './results.js';
export type QueryWhat = QueryCommand['what'];

/** The frames of an `advance` that its viewer gets, regardless of its `hz`. */
export type AdvanceFrames = NonNullable<AdvanceCommand['frames']>;

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

export interface Roster {
  op: 'roster';
  viewers: Viewer[];
}

export interface PresenceNews {
  op: 'presence';
  viewers: Presence[];
}

export interface Pins {
  op: 'pins';
  tick: number;
  pins: Pin[];
}

export interface Grabs {
  op: 'grabs';
  tick: number;
  grabs: Grab[];
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

/** The answer to a command; what it has follows from the command, as far as this client knows it. */
export type Answer<Op extends string> = { op: 'result'; id: number | string; command: Op } & (Op extends keyof Results
  ? Results[Op]
  : { tick?: number; [field: string]: any });

/** What each query answers in the format `json`. */
export interface QueryData {
  positions: Vec3[];
  velocities: Vec3[];
  boxes: number[][];
  energies: Energy;
  strain: Strain;
  pins: Pin[];
  grabs: Grab[];
  camera: (Camera & { viewer: number })[];
  roster: Viewer[];
  state: State;
  work: StageWork[];
  trees: Tree[];
  colliders: ColliderPose[];
  measurements: Record<string, number>;
  contacts: Contact[];
  reactions: Reactions;
  grippers: GripperState[];
  crossings: Crossings;
  balance: EnergyBalance;
}

export interface QueryOptions {
  format?: 'json' | 'f32' | 'f64';
  viewer?: number;
  tree?: string;
  level?: number;
}

/** What a query with these options answers. */
export type QueryAnswer<What extends QueryWhat, Options extends QueryOptions> = Options extends {
  format: 'f32' | 'f64';
}
  ? Data
  : QueryData[What];

/** Where to hold: a point of a triangle, or a particle. */
export type Hold = { triangle: number; barycentric: Vec3 } | { particle: number };

export type DragOptions = Omit<
  DragCommand1,
  'phase' | 'drag' | 'particle' | 'triangle' | 'barycentric'
>;

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
  /** It has what `observe` of an `advance` asked for. */
  observed: boolean;
  /** Three values per vertex [m/s], if `observe` asked for them. */
  velocities: Float32Array | null;
  /** If `observe` asked for them. */
  grippers: GripperSample[];
}

export interface GripperSample {
  /** Index in `MeshAnnouncement.colliders` of its left jaw; the right one follows. */
  jaw: number;
  /** It presses something. */
  gripping: boolean;
  /** Of its middle [m]. */
  position: number[];
  /** From its definition, unit quaternion x, y, z, w. */
  rotation: number[];
  /** Between its jaws [m]. */
  opening: number;
  /** Most that each jaw presses with [N]. */
  force: number;
  /** Of the cloth on both jaws, mean of the tick [N]. */
  reaction: number[];
  /** The same about its middle [N m]. */
  torque: number[];
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

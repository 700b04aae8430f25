// Types of the messages of weft.v1. proto/README.md gives the meaning and unit of each field.

import type { AdvanceCommand, DragCommand1, QueryCommand } from './commands.js';
import type { State } from './events.js';
import type { FrameParts } from './frame_parts.js';
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
  AppliedCommand,
  ContactSample,
  FrameParts,
  GrabSample,
  GripperSample,
  PoseSample,
  ReactionSample,
} from './frame_parts.js';
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

export interface Frame extends FrameParts {
  type: 'frame';
  tick: number;
  time: number;
  serverTime: number;
  sequence: number;
  reference: number;
  epoch: number;
  /** Three values per vertex [m]. */
  positions: Float32Array;
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

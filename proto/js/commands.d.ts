// Written by proto/generate.py from the descriptions in proto/messages. Do not edit.

import type { Vec3 } from './messages.js';
import type { Camera, Fabric, Fan } from './parts.js';

/** The fields of `hello`. */
export interface HelloCommand {
  /** without control characters; 1 to 32 characters */
  name?: string;
  /** as `#rrggbb` */
  color?: string;
  /** of a link; tells the role; 0 to 256 bytes */
  token?: string;
}

/** The fields of `pick`. */
export interface PickCommand {
  /** where the ray starts [m]; 3 × ±10000 */
  origin: Vec3;
  /** of any length but 0: its largest component is at least 1e-9; 3 × ±10000 */
  direction: Vec3;
}

/** The fields of `drag`. */
export interface DragCommand1 {
  phase: 'start';
  /** the viewer's own number for it; 0 to 2147483647 */
  drag?: number;
  /** to hold it at a particle; 0 to 2147483647 */
  particle?: number;
  /** to hold it at a point of this triangle; 0 to 2147483647 */
  triangle?: number;
  /** of that point; sum 1 within 0.001; 3 × 0 to 1 */
  barycentric?: Vec3;
  /** `sling` leaves the cloth alone until `end`; `live` or `sling` */
  mode?: 'live' | 'sling';
  /** where it is pulled to; by default where that point is now [m]; 3 × ±10000 */
  target?: Vec3;
  /** of the held disc in the fabric [m]; 0 to 100 */
  radius?: number;
  /** of the hand; of a sling by default 20 [N/m]; 0 to 100000 */
  stiffness?: number;
  /** beyond which the cloth lags [N]; 0 to 1 000 000 */
  max_force?: number;
}

/** The fields of `drag`. */
export interface DragCommand2 {
  phase: 'move';
  /** the viewer's own number for it; 0 to 2147483647 */
  drag?: number;
  /** where it is pulled to [m]; 3 × ±10000 */
  target: Vec3;
}

/** The fields of `drag`. */
export interface DragCommand3 {
  phase: 'end';
  /** the viewer's own number for it; 0 to 2147483647 */
  drag?: number;
  /** of a sling: give the impulse; `true` or `false` */
  fire?: boolean;
}

export type DragCommand = DragCommand1 | DragCommand2 | DragCommand3;

/** The fields of `pin`. */
export interface PinCommand {
  /** to hold it at a particle; 0 to 2147483647 */
  particle?: number;
  /** to hold it at a point of this triangle; 0 to 2147483647 */
  triangle?: number;
  /** of that point; sum 1 within 0.001; 3 × 0 to 1 */
  barycentric?: Vec3;
  /** of the fixed disc in the fabric; 0: the particle alone [m]; 0 to 100 */
  radius?: number;
}

/** The fields of `release`. */
export interface ReleaseCommand1 {
  /** id of the pin; 0 to 4294967295 */
  pin: number;
}

/** The fields of `release`. */
export interface ReleaseCommand2 {
  /** all pins that hold it; none is no error; 0 to 2147483647 */
  particle: number;
}

/** The fields of `release`. */
export interface ReleaseCommand3 {
  all: true;
}

export type ReleaseCommand = ReleaseCommand1 | ReleaseCommand2 | ReleaseCommand3;

/** The fields of `camera`. */
export interface CameraCommand {
  /** of the eye [m]; 3 × ±10000 */
  position: Vec3;
  /** what it looks at; not the same point [m]; 3 × ±10000 */
  target: Vec3;
  /** a direction; 3 × ±10000 */
  up?: Vec3;
  /** vertical angle of view [degrees]; 1 to 179 */
  fov?: number;
}

/** The fields of `pause`. */
export interface PauseCommand {
}

/** The fields of `resume`. */
export interface ResumeCommand {
}

/** The fields of `step`. */
export interface StepCommand {
  /** ticks; 1 to 600 */
  n?: number;
}

/** The fields of `reset`. */
export interface ResetCommand {
}

/** The fields of `save`. */
export interface SaveCommand {
  /** lower-case letters, digits and hyphens; 1 to 32 characters */
  name: string;
}

/** The fields of `restore`. */
export interface RestoreCommand {
  /** lower-case letters, digits and hyphens; 1 to 32 characters */
  name: string;
}

/** The fields of `speed`. */
export interface SpeedCommand {
  /** simulated per real time; 0.01 to 10 */
  speed: number;
}

/** The fields of `move`. */
export interface MoveCommand1 {
  /** its name, or its place in the list of `mesh` */
  collider: string | number;
  /** target of its pivot; without it, as it is now [m]; 3 × ±1000 */
  position?: Vec3;
  /** relative to its definition; without it, as it is now; unit quaternion */
  rotation?: number[];
  /** at most [m/s]; 0.001 to 20 */
  speed?: number;
  /** at most [rad/s]; 0.001 to 60 */
  turn_speed?: number;
  /** go on through cloth that cannot give way; `true` or `false` */
  force?: boolean;
}

/** The fields of `move`. */
export interface MoveCommand2 {
  /** its name, or its place in the list of `mesh` */
  collider: string | number;
  release: true;
}

/** The fields of `move`. */
export interface MoveCommand3 {
  /** id of any pin, the scene's too; 0 to 4294967295 */
  pin: number;
  /** target of its `particle` [m]; 3 × ±10000 */
  position: Vec3;
  /** duration, in place of a speed [s]; 0.001 to 3600 */
  seconds?: number;
  /** at most [m/s]; 0.001 to 20 */
  speed?: number;
  /** on the cloth during the motion [N]; 0 to 1 000 000 */
  max_force?: number;
}

/** The fields of `move`. */
export interface MoveCommand4 {
  /** id of any pin, the scene's too; 0 to 4294967295 */
  pin: number;
  stop: true;
}

export type MoveCommand = MoveCommand1 | MoveCommand2 | MoveCommand3 | MoveCommand4;

/** The fields of `gripper`. */
export interface GripperCommand {
  /** of the gripper; 1 to 56 bytes */
  name: string;
  /** between its jaws; 0 closes on what is there [m]; 0 to 1 */
  opening?: number;
  /** with which each jaw presses [N]; 0 to 1000 */
  force?: number;
  /** target of its middle [m]; 3 × ±1000 */
  position?: Vec3;
  /** relative to its definition; without it, as it is now; unit quaternion */
  rotation?: number[];
  /** of its middle, at most [m/s]; 0.001 to 20 */
  speed?: number;
  /** at most [rad/s]; 0.001 to 60 */
  turn_speed?: number;
}

/** The fields of `set`. */
export interface SetCommand {
  /** acceleration [m/s²]; 3 × ±1000 */
  gravity?: Vec3;
  /** mean velocity [m/s]; 3 × ±100 */
  wind?: Vec3;
  /** bound of each component of the gusts [m/s]; 0 to 100 */
  gust_speed?: number;
  /** size of an eddy [m]; 0.01 to 100 */
  gust_length?: number;
  /** of the air [kg/m³]; 0 to 1000 */
  air_density?: number;
  /** air resists without wind too; `true` or `false` */
  still_air?: boolean;
  /** uniform damping of velocities [1/s]; 0 to 1000 */
  drag?: number;
  /** all local winds; list of at most 4 */
  fans?: Fan[];
  /** fraction of the springs' stiffness; 0.01 to 1 */
  softness?: number;
  /** for each tick that is due; 0: no bound [ms]; 0 to 1000 */
  budget_ms?: number;
  /** what gives way beyond it; `slow` or `soften` */
  over_budget?: 'slow' | 'soften';
  /** of one cloth */
  fabric?: Fabric;
  /** whose fabric: its name, or its place in the list of `mesh`; the first by default */
  cloth?: string | number;
}

/** The fields of `advance`. */
export interface AdvanceCommand {
  /** ticks; 1 to 100000 */
  n: number;
  /** its frames that its viewer gets, whatever its `hz`; by default those that its `hz` allows; `none` or `last` or `all` */
  frames?: 'none' | 'last' | 'all';
  /** what the frame of its last tick has, beside positions; then `frames` is at least `last`; list of `positions`, `velocities`, `contacts`, `reactions`, `grippers` */
  observe?: ('positions' | 'velocities' | 'contacts' | 'reactions' | 'grippers')[];
}

/** The fields of `query`. */
export interface QueryCommand {
  /** what to read; see the table below; `positions` or `velocities` or `energies` or `strain` or `pins` or `grabs` or `camera` or `roster` or `state` or `work` or `trees` or `boxes` or `colliders` or `measurements` or `contacts` or `reactions` or `grippers` or `crossings` or `balance` */
  what: 'positions' | 'velocities' | 'energies' | 'strain' | 'pins' | 'grabs' | 'camera' | 'roster' | 'state' | 'work' | 'trees' | 'boxes' | 'colliders' | 'measurements' | 'contacts' | 'reactions' | 'grippers' | 'crossings' | 'balance';
  /** binary ones are for positions, velocities and boxes alone; `json` or `f32` or `f64` */
  format?: 'json' | 'f32' | 'f64';
  /** of `camera`: that one alone; 0 to 4294967295 */
  viewer?: number;
  /** one that `trees` lists; 1 to 80 bytes */
  tree?: string;
  /** 0: one box around everything; 0 to 255 */
  level?: number;
}

/** The fields of `hash`. */
export interface HashCommand {
}

/** The fields of `ping`. */
export interface PingCommand {
  /** the client's time; ±1e+300 */
  t: number;
}

/** The fields of `load`. */
export interface LoadCommand {
  /** its name, or a scene that follows `/api/v1/scene-schema`; 1 to 64 characters */
  scene: string | object;
}

/** The fields of `view`. */
export interface ViewCommand {
  /** most frames a second; 0: none; 0 to 240 */
  hz?: number;
  /** of the positions in frames; `f32` or `packed` */
  codec?: 'f32' | 'packed';
  /** most that a packed vertex may be off [m]; 1e-05 to 1 */
  error?: number;
  /** contacts and reactions in the frames; `true` or `false` */
  forces?: boolean;
}

/** The fields of `create_room`. */
export interface CreateRoomCommand {
  /** lower-case letters, digits and hyphens; 1 to 32 characters */
  name: string;
  /** its name; by default that with which the server was started; 1 to 64 characters */
  scene?: string;
  /** it begins paused; `true` or `false` */
  paused?: boolean;
}

/** The fields of `list_rooms`. */
export interface ListRoomsCommand {
}

/** The fields of `close_room`. */
export interface CloseRoomCommand {
  /** lower-case letters, digits and hyphens; 1 to 32 characters */
  name: string;
}

/** The fields of `fork`. */
export interface ForkCommand {
  /** lower-case letters, digits and hyphens; 1 to 32 characters */
  name: string;
  /** whether it begins so; by default as this room is; `true` or `false` */
  paused?: boolean;
}

/** The fields of `policy`. */
export interface PolicyCommand {
  /** who may hold the cloth; `watch` or `one_hand` or `everybody` */
  policy: 'watch' | 'one_hand' | 'everybody';
}

/** The fields of `mute`. */
export interface MuteCommand {
  /** whose hands let go; 0 to 4294967295 */
  viewer: number;
  /** `false`: the policy holds for it again; `true` or `false` */
  muted?: boolean;
}

/** The fields of `give_hand`. */
export interface GiveHandCommand {
  /** that may hold; 0 to 4294967295 */
  viewer: number;
  /** `false`: the policy holds for it again; `true` or `false` */
  given?: boolean;
}

/** The fields of `presence`. */
export interface PresenceCommand {
  /** what it points at [m]; 3 × ±10000 */
  cursor?: Vec3;
  /** it points at nothing any more; `true` or `false` */
  away?: boolean;
  /** where it looks from */
  camera?: Camera;
}

/** The fields of `follow`. */
export interface FollowCommand {
  /** by whose camera it sees; 0: its own again; 0 to 4294967295 */
  viewer: number;
}

/** The fields of `lead`. */
export interface LeadCommand {
  /** `false`: those that follow its sender see by their own again; `true` or `false` */
  on?: boolean;
}

/** The fields of `invite`. */
export interface InviteCommand {
  /** of who comes by it; `look` or `hold` or `operate` */
  right: 'look' | 'hold' | 'operate';
}

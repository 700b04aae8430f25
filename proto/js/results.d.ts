// Written by proto/generate.py from the descriptions in proto/messages. Do not edit.

import type { Vec3 } from './messages.js';
import type { Hit, RoomInfo } from './parts.js';

/** What the answer to `hello` has. */
export interface HelloResult {
  /** its number */
  viewer: number;
  /** in force */
  name: string;
  /** in force */
  color: string;
  /** what it may do; `viewer` or `operator` or `admin` */
  role: 'viewer' | 'operator' | 'admin';
}

/** What the answer to `invite` has. */
export interface InviteResult {
  /** the command's place in the order: after it */
  tick: number;
  /** for a link's fragment, `#token=…` */
  token: string;
}

/** What the answer to `pick` has. */
export interface PickResult {
  /** the command's place in the order: after it */
  tick: number;
  /** null: the ray meets no cloth */
  hit: Hit | null;
}

/** What the answer to `drag` has. */
export interface DragResult {
  /** the command's place in the order: after it */
  tick: number;
  /** the viewer's number */
  drag: number;
  /** the room's number of the hand */
  grab: number;
  /** of a start [m] */
  target?: Vec3;
  /** of a sling that was fired [N s] */
  impulse?: Vec3;
}

/** What the answer to `pin` has. */
export interface PinResult {
  /** the command's place in the order: after it */
  tick: number;
  /** its id */
  pin: number;
  /** its centre */
  particle: number;
  /** particles that it holds */
  count: number;
}

/** What the answer to `release` has. */
export interface ReleaseResult {
  /** the command's place in the order: after it */
  tick: number;
  /** ids of the pins that are gone */
  released: number[];
}

/** What the answer to `step` has. */
export interface StepResult {
  /** the command's place in the order: after it */
  tick: number;
  /** tick at which the room stands still again */
  until: number;
}

/** What the answer to `speed` has. */
export interface SpeedResult {
  /** the command's place in the order: after it */
  tick: number;
  /** simulated per real time */
  speed: number;
}

/** What the answer to `move` has. */
export interface MoveResult1 {
  /** the command's place in the order: after it */
  tick: number;
  /** as in the command */
  collider: string | number;
}

/** What the answer to `move` has. */
export interface MoveResult2 {
  /** the command's place in the order: after it */
  tick: number;
  /** its id */
  pin: number;
  /** where it was [m] */
  position: Vec3;
}

/** What the answer to `gripper` has. */
export interface GripperResult {
  /** the command's place in the order: after it */
  tick: number;
  /** its name */
  gripper: string;
}

/** What the answer to `advance` has. */
export interface AdvanceResult {
  /** the command's place in the order: after it */
  tick: number;
  /** of the state */
  hash: string;
}

/** What the answer to `hash` has. */
export interface HashResult {
  /** the command's place in the order: after it */
  tick: number;
  /** of the state */
  hash: string;
}

/** What the answer to `ping` has. */
export interface PingResult {
  /** as sent */
  t: number;
  /** by the server's clock [s] */
  received: number;
  /** by the server's clock [s] */
  sent: number;
}

/** What the answer to `load` has. */
export interface LoadResult {
  /** the command's place in the order: after it */
  tick: number;
  /** its name */
  scene: string;
  /** of its mesh */
  epoch: number;
}

/** What the answer to `create_room` has. */
export interface CreateRoomResult {
  /** as it begins */
  room: RoomInfo;
}

/** What the answer to `list_rooms` has. */
export interface ListRoomsResult {
  /** by name */
  rooms: RoomInfo[];
  /** rooms that this server has at a time */
  most: number;
}

/** What the answer to `close_room` has. */
export interface CloseRoomResult {
  /** of the room that is gone */
  name: string;
}

/** What the answer to `fork` has. */
export interface ForkResult {
  /** the command's place in the order: after it */
  tick: number;
  /** as it begins */
  room: RoomInfo;
  /** with which its maker, who comes by a token, operates the copy */
  token?: string;
}

/** What the answer to `view` has. */
export interface ViewResult {
  /** most frames a second */
  hz: number;
  /** of the positions in frames; `f32` or `packed` */
  codec: 'f32' | 'packed';
  /** most that a vertex may be off [m] */
  error?: number;
  /** contacts and reactions in the frames; `true` or `false` */
  forces: boolean;
}

/** What the answers have, by the command. */
export interface Results {
  pause: { tick: number; paused: boolean };
  resume: { tick: number; paused: boolean };
  camera: { tick: number };
  set: { tick: number };
  reset: { tick: number };
  save: { tick: number };
  restore: { tick: number };
  policy: { tick: number };
  mute: { tick: number };
  give_hand: { tick: number };
  presence: { tick: number };
  follow: { tick: number };
  lead: { tick: number };
  hello: HelloResult;
  invite: InviteResult;
  pick: PickResult;
  drag: DragResult;
  pin: PinResult;
  release: ReleaseResult;
  step: StepResult;
  speed: SpeedResult;
  move: MoveResult1 | MoveResult2;
  gripper: GripperResult;
  advance: AdvanceResult;
  hash: HashResult;
  ping: PingResult;
  load: LoadResult;
  create_room: CreateRoomResult;
  list_rooms: ListRoomsResult;
  close_room: CloseRoomResult;
  fork: ForkResult;
  view: ViewResult;
}

// Written by proto/generate.py from proto/frames. Do not edit.

/** One for each hand. */
export interface GrabSample {
  id: number;
  /** 0: the scene. */
  viewer: number;
  /** The point of the cloth [m]. */
  held: number[];
  /** Where the hand is [m]. */
  target: number[];
  /** Magnitude [N]. */
  force: number;
}

/** One for each viewer that has sent something. */
export interface AppliedCommand {
  viewer: number;
  /** Of its last text message that this frame includes, from 1. */
  number: number;
}

/** One for each collider that is not as defined. */
export interface PoseSample {
  /** Its place in `colliders` of `mesh`. */
  collider: number;
  /** Of its pivot [m]. */
  position: number[];
  /** Unit quaternion x y z w. */
  rotation: number[];
}

/** One for each contact of the cloth. */
export interface ContactSample {
  /** The other side's place in `colliders` of `mesh`; none for cloth. */
  collider: number | null;
  /** Of the cloth, with the largest weight. */
  particle: number;
  /** Of the cloth's mid-surface [m]. */
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

/** One for each pin or collider that bears the cloth. */
export interface ReactionSample {
  /** Whose it is; a number, if this client does not know its meaning. */
  of: 'pin' | 'collider' | number;
  /** Of the pin, or the collider's place in `colliders` of `mesh`. */
  id: number;
  /** Of a pin on the cloth, of the cloth on a collider [N]. */
  force: number[];
}

/** One for each gripper. */
export interface GripperSample {
  /** Its left jaw's place in `colliders` of `mesh`; the right one follows. */
  jaw: number;
  /** It presses something. */
  gripping: boolean;
  /** Of its middle [m]. */
  position: number[];
  /** From its definition, unit quaternion x y z w. */
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

/** What a frame has beside times and positions. */
export interface FrameParts {
  flags: number;
  /** It builds on no other frame (always in codec 0). */
  key: boolean;
  /** The state was replaced (reset, load, recovery), so do not interpolate to it. */
  jump: boolean;
  /** The room is paused. */
  paused: boolean;
  /** It has what `observe` of an `advance` asked for. */
  observed: boolean;
  grabs: GrabSample[];
  applied: AppliedCommand[];
  /** Its point p is at position + rotation (p - pivot). */
  poses: PoseSample[];
  /** If `view` or `observe` asked for them; as in `query`. */
  contacts: ContactSample[];
  /** If `view` or `observe` asked for them; as in `query`. */
  reactions: ReactionSample[];
  /** If `observe` asked for them; as in `query`. */
  grippers: GripperSample[];
  /** Three values per vertex [m/s], if `observe` asked for them. */
  velocities: Float32Array | null;
}

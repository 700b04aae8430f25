import type { WeftClient } from '../../../proto/js/index.js';
import type { Viewer } from '../../../proto/js/messages.js';
import type { OrbitCamera } from '../view/camera.js';
import type { Fans } from '../view/fans.js';
import type { Pins } from '../view/pins.js';
import type { WorldView } from '../view/world_view.js';
import type { HandMode } from './hold.js';

/** What hands reach for, and where they report to. */
export interface Reach {
  readonly client: WeftClient;
  readonly orbit: OrbitCamera;
  readonly fans: Fans;
  readonly pins: Pins;
  world(): WorldView | null;
  viewer(id: number): Viewer | undefined;
  hand_mode(): HandMode;
  /** Whether a hand takes objects too, not just cloth, fans and grippers. */
  moves_objects(): boolean;
  /** Whether the pointer of a hand is a finger. */
  is_finger(hand: number): boolean;
  /** Size of the view [pixels]. */
  size(): { width: number; height: number };
  /** Shows the fans as the server has them, unless one is held. */
  show_fans(): void;
  tell(text: string): void;
  /** A hand let go of the cloth without being told to. */
  lost(hand: number, reason: string): void;
}

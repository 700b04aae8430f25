import type { WeftClient } from '../../../proto/js/index.js';
import type { Vec3 } from '../../../proto/js/messages.js';

const INTERVAL = 0.1; // between two messages [s]

/** Tells the server from where this viewer looks, after each change, but not too often. */
export class ToldCamera {
  private told_at = 0; // [s]
  private moved = true;

  constructor(private client: WeftClient) {}

  /** The camera has moved, or the server does not know of it yet. */
  renew(): void {
    this.moved = true;
  }

  /** @param now [s] */
  tell(camera: { position: Vec3; target: Vec3; fov: number }, now: number): void {
    if (!this.moved || !this.client.connected || now - this.told_at < INTERVAL) return;
    this.moved = false;
    this.told_at = now;
    this.client.post('camera', camera);
  }
}

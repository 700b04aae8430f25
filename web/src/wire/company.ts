import type { WeftClient } from '../../../proto/js/index.js';
import type { Camera, Vec3 } from '../../../proto/js/messages.js';

const INTERVAL = 0.1; // between two messages on where this viewer points [s]
const LEAST_MOVE = 1e-3; // of the cursor that is told [m]
const SHOWN = 10; // a cursor that rests goes after this time [s]

/** What another viewer points at. */
export interface Cursor {
  viewer: number;
  place: Vec3;
}

interface Actions {
  /** Shows what another camera sees. */
  see(camera: Camera): void;
  /** Cursors, or whom this viewer follows. */
  changed(): void;
}

/** Where others point and look, and where this viewer points. */
export class Company {
  private cursors = new Map<number, { place: Vec3; until: number }>();
  private cameras = new Map<number, Camera>(); // as last told; one may come before it is followed
  private told: Vec3 | null = null;
  private told_at = 0; // [s]
  /** By whose camera this viewer sees; 0: its own. */
  follows = 0;

  constructor(
    private client: WeftClient,
    private actions: Actions,
  ) {
    client.on('presence', ({ viewers }) => {
      const last = this.seen;
      for (const { viewer, cursor, away, camera, follows } of viewers) {
        if (viewer === client.viewer) {
          if (follows !== undefined) this.follows = follows;
          continue;
        }
        if (cursor) this.cursors.set(viewer, { place: cursor, until: now() + SHOWN });
        if (away) this.cursors.delete(viewer);
        if (camera) this.cameras.set(viewer, camera);
      }
      const { seen } = this;
      if (seen && seen !== last) this.actions.see(seen);
      this.actions.changed();
    });
    client.on('roster', ({ viewers }) => {
      const here = new Set(viewers.map(({ id }) => id));
      for (const told of [this.cursors, this.cameras])
        for (const viewer of [...told.keys()]) if (!here.has(viewer)) told.delete(viewer);
    });
    client.on('status', ({ phase }) => {
      if (phase === 'open') return;
      this.cursors.clear();
      this.cameras.clear();
      this.told = null;
      this.follows = 0;
      this.actions.changed();
    });
  }

  /** The camera by which this viewer sees; undefined: its own. */
  private get seen(): Camera | undefined {
    return this.cameras.get(this.follows);
  }

  /** What others point at, the newest first. */
  get shown(): Cursor[] {
    const list = [...this.cursors].filter(([, { until }]) => until > now());
    list.sort(([, a], [, b]) => b.until - a.until);
    return list.map(([viewer, { place }]) => ({ viewer, place }));
  }

  /** Tells others what this viewer points at; null: nothing. */
  point(place: Vec3 | null): void {
    const time = now();
    if (!this.client.connected || time - this.told_at < INTERVAL || !moved(this.told, place)) return;
    this.told = place;
    this.told_at = time;
    this.client.post('presence', place ? { cursor: place } : { away: true });
  }

  /** Sees by its own camera from now on, because its viewer has touched it. */
  leave(): void {
    if (this.follows === 0) return;
    this.follows = 0;
    this.client.post('follow', { viewer: 0 });
    this.actions.changed();
  }
}

function now(): number {
  return performance.now() / 1000;
}

function moved(from: Vec3 | null, to: Vec3 | null): boolean {
  if (!from || !to) return from !== to;
  return Math.hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]) > LEAST_MOVE;
}

import type { WeftClient } from '../../../proto/js/index.js';
import type { Results } from '../../../proto/js/messages.js';

const PAUSE = 1000; // between two looks at the rooms [ms]

export type Room = Results['list_rooms']['rooms'][number];

/** Looks at the server's rooms once a second, while they are shown. */
export class RoomWatch {
  private timer = 0;
  private on = false;

  constructor(
    private client: WeftClient,
    private seen: (rooms: Room[], most: number) => void,
  ) {}

  start(): void {
    this.on = true;
    void this.look();
  }

  stop(): void {
    this.on = false;
    window.clearTimeout(this.timer);
  }

  /** Looks now, as after something has changed. */
  async look(): Promise<void> {
    window.clearTimeout(this.timer);
    if (!this.on) return;
    try {
      if (!document.hidden) {
        const { rooms, most } = await this.client.listRooms();
        if (this.on) this.seen(rooms, most);
      }
    } catch {
      // The connection is lost, which the page shows; the next look may find it again.
    }
    window.clearTimeout(this.timer);
    if (this.on) this.timer = window.setTimeout(() => void this.look(), PAUSE);
  }
}

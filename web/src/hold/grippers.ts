import type { WeftClient } from '../../../proto/js/index.js';
import type { Collider, Vec3 } from '../../../proto/js/messages.js';
import { tell_refusal } from '../wire/connection.js';

const JAWS = ['.left', '.right']; // ends of the jaws' names, by the wire
const LEAST_OPENING = 0.04; // of a gripper that opens [m]
const SPEED = 2; // at which it follows the hand [m/s]

interface GripperState {
  name: string;
  opening: number; // [m]
  gripping: boolean;
}

/** The scene's grippers, as hands carry, close and open them. */
export class Grippers {
  private widest = new Map<string, number>(); // opening that was seen [m]

  constructor(
    private client: WeftClient,
    private tell: (text: string) => void,
  ) {}

  get none(): boolean {
    return this.widest.size === 0;
  }

  /** Asks which grippers there are, as for a new mesh. */
  renew(): void {
    this.widest.clear();
    this.ask().catch(() => {}); // the connection's state shows its loss
  }

  /** The gripper that a collider is a jaw of, and its jaws' places in the list; or null. */
  of_jaw(colliders: Collider[], place: number): { name: string; jaws: number[] } | null {
    const own = colliders[place]?.name ?? '';
    const name = JAWS.filter((end) => own.endsWith(end)).map((end) => own.slice(0, -end.length))[0];
    if (name === undefined || !this.widest.has(name)) return null;
    const jaws = JAWS.map((end) => colliders.findIndex((each) => each.name === name + end));
    return { name, jaws };
  }

  /** @param position of the middle between its jaws [m] */
  carry(name: string, position: Vec3): void {
    tell_refusal(this.client.gripper(name, { position, speed: SPEED }), this.tell);
  }

  /** Closes a gripper on what is between its jaws, or opens it if it is closed. */
  squeeze(name: string): void {
    tell_refusal(this.squeeze_now([name]), this.tell);
  }

  /** The same for all. */
  squeeze_all(): void {
    tell_refusal(this.squeeze_now([...this.widest.keys()]), this.tell);
  }

  private async squeeze_now(names: string[]): Promise<void> {
    for (const { name, opening, gripping } of await this.ask()) {
      if (!names.includes(name)) continue;
      const wide = Math.max(LEAST_OPENING, this.widest.get(name) ?? 0);
      const closed = gripping || opening < wide / 2;
      await this.client.gripper(name, { opening: closed ? wide : 0 });
    }
  }

  private async ask(): Promise<GripperState[]> {
    const list = (await this.client.query('grippers')) as GripperState[];
    for (const { name, opening } of list)
      this.widest.set(name, Math.max(opening, this.widest.get(name) ?? 0));
    return list;
  }
}

import { CommandError, type WeftClient } from '../../../proto/js/index.js';
import { address_in, FIRST_ROOM, own_room, own_token, socket_of } from '../wire/own_address.js';
import { element } from './element.js';
import type { RoomDialog } from './room_dialog.js';
import { room_tools } from './room_tools.js';

const ONLY_LOOKS = 'You only look: with a hand you can make a copy of your own';

/** The room that the page is in: its name, a copy of it in one click, the way back, and all rooms. */
export class RoomPanel {
  private dialog: Promise<RoomDialog> | null = null; // loaded when it is first opened
  private role = 'viewer';
  private address = socket_of(own_room()); // of the socket that is open
  private token = own_token(); // with which it was opened
  private copies = false; // a copy is being made
  private words = element('copy').title;
  private many = false; // whether the server has more than one room

  constructor(
    private client: WeftClient,
    private tell: (text: string) => void,
  ) {
    client.on('welcome', ({ capabilities }) => {
      this.many = capabilities.includes('rooms');
      this.show();
    });
    client.on('status', ({ phase }) => this.offer_copy(phase === 'open'));
    client.on('roster', ({ viewers }) => {
      const own = viewers.find(({ id }) => id === client.viewer);
      this.role = own?.role ?? 'viewer';
      const holds = own?.hand !== false;
      this.offer_copy(holds, holds ? undefined : ONLY_LOOKS);
      void this.dialog?.then((dialog) => dialog.show_role(this.role)).catch(() => {});
    });
    element('room').addEventListener('click', () => void this.open());
    element('copy').addEventListener('click', () => void this.copy());
    element('room-back').addEventListener('click', () => this.go_back());
    window.addEventListener('popstate', () => this.follow_address());
    this.show();
  }

  /** Opens a room that is like this one at this moment, and goes there. */
  async copy(): Promise<void> {
    if (this.copies) return;
    this.copies = true;
    try {
      const { fork_room } = await import('./room_copy.js');
      const { name, token } = await fork_room(this.client);
      this.go(name, token);
    } catch (error) {
      if (error instanceof CommandError) this.tell(refusal_text(error));
    }
    this.copies = false;
  }

  /** Goes to a room; the browser's Back leads here again. @param token another one than here */
  go(room: string, token?: string): void {
    if (room === own_room()) return;
    window.history.pushState({ from: own_room() }, '', address_in(room, token));
    this.follow_address();
  }

  /** The list of rooms is no part of the first load. */
  async open(): Promise<void> {
    if (element<HTMLButtonElement>('room').closest('[hidden]')) return;
    const go = (room: string) => this.go(room);
    this.dialog ??= import('./room_dialog.js').then(
      ({ RoomDialog }) => new RoomDialog(this.client, { ...room_tools, go }),
    );
    const dialog = await this.dialog.catch(() => (this.dialog = null));
    dialog?.show_role(this.role);
    await dialog?.open().catch(() => {}); // the server is away; the next press tries again
  }

  private offer_copy(offered: boolean, words = this.words): void {
    const button = element<HTMLButtonElement>('copy');
    button.disabled = !offered;
    button.title = words;
  }

  private go_back(): void {
    if (this.from) window.history.back();
    else this.go(FIRST_ROOM);
  }

  /** The room from which the viewer came to this one; empty if it came by a link. */
  private get from(): string {
    const state: unknown = window.history.state;
    return state !== null && typeof state === 'object' && 'from' in state ? String(state.from) : '';
  }

  /**
   * Goes where the address leads, as after the browser's Back, or once a whole link was pasted where the page was not
   * let in: browsers load nothing anew for what follows the #.
   */
  private follow_address(): void {
    const [address, token] = [socket_of(own_room()), own_token()];
    this.show();
    if (address !== this.address || token !== this.token) this.client.enter(address, token);
    this.address = address;
    this.token = token;
  }

  private show(): void {
    const room = own_room();
    const first = room === FIRST_ROOM;
    element('room-line').hidden = first && !this.many;
    element('room-name').textContent = element('room-name').title = room;
    document.title = first ? 'Weft' : `${room} · Weft`;
    element('room-back').hidden = first && !this.from;
    element('room-back').title = `Back to ${this.from || FIRST_ROOM}`;
  }
}

/** Why there is no copy, in words. */
function refusal_text({ code, message }: CommandError): string {
  if (code === 'not_allowed') return ONLY_LOOKS;
  return `No copy was made: ${message}`;
}

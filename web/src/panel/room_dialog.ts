import type { WeftClient } from '../../../proto/js/index.js';
import { late_styles } from './late_styles.js';
import type { RoomTools } from './room_tools.js';
import { type Room, RoomWatch } from './room_watch.js';
import { write } from './room_words.js';
import { Wall } from './wall.js';

const part = <Type extends HTMLElement>(id: string) => document.getElementById(id) as Type;
const HEADS = ['Room', 'Scene', 'People', 'Tick', 'Time'];

/** A room's line in the list. */
interface Line {
  row: HTMLTableRowElement;
  open: HTMLButtonElement;
  cells: HTMLTableCellElement[];
  close: HTMLButtonElement;
}

/**
 * The server's rooms as a list, in which an operator opens and closes them, and the way to the wall. Like the wall it
 * is no part of the page's first load, and imports nothing that the page has already.
 */
export class RoomDialog {
  private dialog = part<HTMLDialogElement>('rooms');
  private body = document.createElement('tbody');
  private form = part<HTMLFormElement>('room-form');
  private name = part<HTMLInputElement>('new-room');
  private scene = part<HTMLSelectElement>('new-scene');
  private lines = new Map<string, Line>();
  private watch: RoomWatch;
  private wall: Wall;
  private operates = false;

  constructor(
    private client: WeftClient,
    private tools: RoomTools,
  ) {
    this.watch = new RoomWatch(client, (rooms, most) => this.show(rooms, most));
    this.wall = new Wall(client, tools);
    part('room-list').replaceChildren(this.table());
    this.dialog.addEventListener('click', ({ target }) => target === this.dialog && this.dialog.close());
    this.dialog.addEventListener('close', () => this.watch.stop());
    this.form.addEventListener('submit', (event) => {
      event.preventDefault();
      this.create();
    });
    part('to-wall').addEventListener('click', () => {
      this.dialog.close();
      this.wall.open();
    });
  }

  async open(): Promise<void> {
    if (this.dialog.open) return;
    await late_styles('rooms.css');
    if (!this.scene.options.length) await this.fetch_scenes();
    this.dialog.showModal();
    this.watch.start();
  }

  /** An operator may open and close rooms. */
  show_role(role: string): void {
    this.operates = role !== 'viewer';
    this.form.hidden = !this.operates;
    for (const [name, line] of this.lines) this.allow(name, line);
  }

  private table(): HTMLTableElement {
    const table = document.createElement('table');
    const head = table.createTHead().insertRow();
    for (const text of HEADS) head.append(cell('th', text, 'col'));
    head.append(document.createElement('td')); // above the buttons that close
    table.append(this.body);
    return table;
  }

  /** Writes what has changed, so that who goes through the list by keys keeps the focus. */
  private show(rooms: Room[], most: number): void {
    const names = new Set(rooms.map(({ name }) => name));
    for (const [name, { row }] of this.lines) {
      if (names.has(name)) continue;
      row.remove();
      this.lines.delete(name);
    }
    for (const [k, room] of rooms.entries()) {
      const line = this.lines.get(room.name) ?? this.line(room.name);
      if (this.body.children[k] !== line.row) this.body.insertBefore(line.row, this.body.children[k] ?? null);
      const texts = [this.tools.title_of(room.scene), String(room.viewers), String(room.tick), this.time_text(room)];
      for (const [place, text] of texts.entries()) write(line.cells[place], text);
      this.allow(room.name, line);
    }
    write(part('room-count'), `${rooms.length} of at most ${most} rooms.`);
  }

  private line(name: string): Line {
    const row = document.createElement('tr');
    const head = cell('th', '', 'row');
    const open = button(name, `Open ${name}`, () => {
      this.dialog.close();
      this.tools.go(name);
    });
    open.title = name; // which may be cut
    head.append(open);
    const cells = HEADS.slice(1).map(() => cell('td', '') as HTMLTableCellElement);
    const close = button('Close', `Close ${name}`, () => this.attempt(this.client.closeRoom(name)));
    const last = cell('td', '');
    last.append(close);
    row.append(head, ...cells, last);
    const line = { row, open, cells, close };
    this.lines.set(name, line);
    return line;
  }

  private allow(name: string, { row, open, close }: Line): void {
    close.hidden = !this.operates || name === this.tools.FIRST_ROOM;
    const here = name === this.tools.own_room();
    row.toggleAttribute('aria-current', here);
    if (here) row.setAttribute('aria-current', 'true');
    open.disabled = here;
  }

  /** How a room's time passes. */
  private time_text({ paused, viewers, name, real_time_factor }: Room): string {
    if (paused) return 'paused';
    if (viewers === 0 && name !== this.tools.FIRST_ROOM) return 'stands while empty';
    return `${real_time_factor.toFixed(2)} ×`;
  }

  private create(): void {
    const made = this.client.createRoom(this.name.value, { scene: this.scene.value });
    this.attempt(made.then(() => (this.name.value = '')));
  }

  /** Tells in the dialog why not: the page's own line is behind it. */
  private attempt(answer: Promise<unknown>): void {
    write(part('room-refusal'), '');
    this.tools.tell_refusal(answer, (text) => write(part('room-refusal'), `${text}.`));
    void answer.then(() => this.watch.look()).catch(() => {});
  }

  private async fetch_scenes(): Promise<void> {
    const answer = await fetch('api/v1/scenes');
    const { scenes } = (await answer.json()) as { scenes: { name: string }[] };
    this.scene.replaceChildren(...scenes.map(({ name }) => new Option(this.tools.title_of(name), name)));
    this.scene.value = this.client.welcome?.scene ?? '';
    if (!this.scene.value) this.scene.selectedIndex = 0;
  }
}

function cell(tag: 'th' | 'td', text: string, scope = ''): HTMLElement {
  const made = document.createElement(tag);
  made.textContent = text;
  if (scope) made.setAttribute('scope', scope);
  return made;
}

function button(words: string, label: string, act: () => void): HTMLButtonElement {
  const made = document.createElement('button');
  made.type = 'button';
  made.className = 'plain';
  made.textContent = words;
  made.setAttribute('aria-label', label);
  made.addEventListener('click', act);
  return made;
}

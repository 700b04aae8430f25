import type { WeftClient } from '../../../proto/js/index.js';
import type { Frame, State } from '../../../proto/js/messages.js';
import { SmallPainter, type SmallScene } from '../view/small_picture.js';
import type { RoomTools } from './room_tools.js';
import { write } from './room_words.js';
import { type Room, RoomWatch } from './room_watch.js';

const SIZE = { width: 288, height: 192 }; // of a picture [pixels]

/** One room of the wall. */
interface Cell {
  client: WeftClient;
  item: HTMLElement;
  canvas: HTMLCanvasElement;
  people: HTMLElement;
  badge: HTMLElement;
  crossings: HTMLElement;
  scene: SmallScene | null;
}

/** All rooms as small pictures, one a second of each, for a teacher who looks after a class. */
export class Wall {
  private dialog = document.getElementById('wall') as HTMLDialogElement;
  private list = document.getElementById('wall-rooms') as HTMLElement;
  private cells = new Map<string, Cell>();
  private painter: SmallPainter | null = null;
  private watch: RoomWatch;

  constructor(
    client: WeftClient,
    private tools: RoomTools,
  ) {
    this.watch = new RoomWatch(client, (rooms) => this.show(rooms));
    this.dialog.addEventListener('close', () => this.end());
    document.addEventListener('visibilitychange', () => {
      for (const cell of this.cells.values()) tools.glance_on(cell.client, !document.hidden);
    });
  }

  open(): void {
    this.painter = new SmallPainter(this.tools);
    this.dialog.showModal();
    this.watch.start();
  }

  /** Leaves no socket and no picture behind. */
  private end(): void {
    this.watch.stop();
    for (const name of [...this.cells.keys()]) this.drop(name);
    this.painter?.dispose();
    this.painter = null;
  }

  private show(rooms: Room[]): void {
    const names = new Set(rooms.map(({ name }) => name));
    for (const name of [...this.cells.keys()]) if (!names.has(name)) this.drop(name);
    for (const [k, { name, viewers, paused }] of rooms.entries()) {
      const cell = this.cells.get(name) ?? this.add(name);
      if (this.list.children[k] !== cell.item) this.list.insertBefore(cell.item, this.list.children[k] ?? null);
      const here = viewers === 0 ? 'nobody there' : viewers === 1 ? '1 person' : `${viewers} people`;
      write(cell.people, paused ? `${here}, paused` : here);
    }
  }

  private add(name: string): Cell {
    const canvas = Object.assign(document.createElement('canvas'), SIZE);
    canvas.setAttribute('aria-hidden', 'true');
    const [people, badge, crossings] = ['people', 'badge', 'crossings'].map((kind) => piece('span', kind));
    const button = document.createElement('button');
    button.type = 'button';
    const title = piece('b', '', name);
    title.title = name; // which may be cut
    button.append(canvas, title, people, badge, crossings);
    button.addEventListener('click', () => {
      this.dialog.close();
      this.tools.go(name);
    });
    const item = document.createElement('li');
    item.append(button);
    const cell: Cell = { client: this.tools.glance_at(name), item, canvas, people, badge, crossings, scene: null };
    this.listen(cell);
    this.cells.set(name, cell);
    return cell;
  }

  private listen(cell: Cell): void {
    cell.client.on('mesh', ({ announcement, data }) => {
      if (cell.scene) this.painter?.forget(cell.scene);
      cell.scene = this.painter?.prepare(announcement, data) ?? null;
      // A room that stands has sent its only frame before the mesh came.
      this.tools.glance_on(cell.client, !document.hidden);
    });
    cell.client.on('frame', (frame: Frame) => cell.scene && this.painter?.paint(cell.scene, frame, cell.canvas));
    cell.client.on('state', (state: State) => this.judge(cell, state));
  }

  /** Says what the server promises of the cloth, and what it has counted. */
  private judge({ badge, crossings }: Cell, { guarantee, crossings: counted }: State): void {
    badge.dataset.state = guarantee.state;
    write(badge, this.tools.guarantee_text(guarantee));
    write(crossings, counted ? this.tools.crossings_text(counted) : '');
    crossings.dataset.crossed = String((counted?.count ?? 0) > 0);
  }

  private drop(name: string): void {
    const cell = this.cells.get(name);
    if (!cell) return;
    cell.client.close();
    if (cell.scene) this.painter?.forget(cell.scene);
    cell.item.remove();
    this.cells.delete(name);
  }
}

function piece(tag: string, kind: string, text = ''): HTMLElement {
  const made = document.createElement(tag);
  made.className = kind;
  made.textContent = text;
  return made;
}

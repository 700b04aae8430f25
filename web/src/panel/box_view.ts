import { CommandError } from '../../../proto/js/index.js';
import type { WeftClient } from '../../../proto/js/index.js';
import type { Data, Tree } from '../../../proto/js/messages.js';
import { Boxes } from '../view/boxes.js';
import { element } from './element.js';

const ASK_INTERVAL = 60; // between requests for boxes that move [ms]
const OPENING_LEVEL = 4;

function title_of(tree: string): string {
  if (tree.startsWith('object:')) return `Model ${tree.slice('object:'.length)}`;
  return `Cloth ${tree}`;
}

/** Draws the boxes of one level of a server's hierarchy, with the panel that selects them. */
export class BoxView {
  readonly boxes = new Boxes();
  /** Of the shown boxes; -1 if none are shown. */
  tick = -1;
  private button = element<HTMLButtonElement>('boxes');
  private panel = element('boxes-panel');
  private tree = element<HTMLSelectElement>('tree');
  private level = element<HTMLInputElement>('level');
  private trees: Tree[] = [];
  private asking = false;
  private asked_at = -Infinity;
  private stale = true; // the choice or the cloth has changed since the last request

  /** @param changed called when the drawn lines change */
  constructor(
    private client: WeftClient,
    private changed: () => void,
    private tell: (message: string) => void,
  ) {
    this.button.addEventListener('click', () => this.toggle());
    this.tree.addEventListener('change', () => this.choose_tree());
    this.level.addEventListener('input', () => this.choose());
  }

  get shown(): boolean {
    return !this.panel.hidden;
  }

  toggle(): void {
    if (this.button.disabled) return;
    this.panel.hidden = this.shown;
    this.button.setAttribute('aria-pressed', String(this.shown));
    if (this.shown) void this.ask_trees();
    else this.clear();
  }

  /** Takes the trees of a new cloth. */
  renew(): void {
    this.clear();
    this.trees = [];
    if (this.shown) void this.ask_trees();
  }

  /** Requests boxes if the shown ones are of another tick. */
  follow(tick: number): void {
    if (!this.shown || this.asking || !this.trees.length || !this.client.connected) return;
    const now = performance.now();
    if (!this.stale && (tick === this.tick || now - this.asked_at < ASK_INTERVAL)) return;
    this.asked_at = now;
    this.asking = true;
    this.stale = false;
    void this.ask_boxes().finally(() => (this.asking = false));
  }

  private async ask_trees(): Promise<void> {
    const trees = (await this.answer(this.client.query('trees'))) as Tree[] | null;
    if (!trees) return;
    const chosen = this.tree.value || 'triangles';
    this.trees = trees;
    this.tree.replaceChildren(...trees.map(({ tree }) => new Option(title_of(tree), tree)));
    this.tree.value = trees.some(({ tree }) => tree === chosen) ? chosen : trees[0].tree;
    this.choose_tree();
  }

  private async ask_boxes(): Promise<void> {
    const { trees, tree, level } = this;
    const options = { tree: tree.value, level: level.valueAsNumber, format: 'f32' as const };
    const data = (await this.answer(this.client.query('boxes', options))) as Data | null;
    // By now the panel may be closed, or the cloth or level changed.
    if (!data || !this.shown || this.trees !== trees || this.stale) return;
    this.boxes.show(data.values);
    this.tick = data.tick;
    const count = data.values.length / data.components;
    element('level-value').textContent = `${options.level} of ${Number(level.max)}`;
    element('box-count').textContent = `${count} ${count === 1 ? 'box' : 'boxes'}`;
    this.changed();
  }

  private async answer(question: Promise<unknown>): Promise<unknown> {
    try {
      return await question;
    } catch (error) {
      if (error instanceof CommandError) this.tell(error.message);
      return null;
    }
  }

  private choose_tree(): void {
    const levels = this.trees.find(({ tree }) => tree === this.tree.value)?.levels ?? 1;
    const before = this.tick < 0 ? OPENING_LEVEL : this.level.valueAsNumber;
    this.level.max = String(levels - 1);
    this.level.value = String(Math.min(before, levels - 1));
    this.choose();
  }

  private choose(): void {
    this.stale = true;
    this.changed();
  }

  private clear(): void {
    this.boxes.show([]);
    this.tick = -1;
    this.stale = true;
    this.changed();
  }
}

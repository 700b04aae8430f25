import type { PerspectiveCamera, Vector3 } from 'three';
import { write_words } from './words.js';

const OFFSET = 14; // from a mark to its label [pixels]
const GAP = 2; // between labels [pixels]
const MOST_SHIFT = 160; // of a label; farther from its mark it tells nothing, and is left out [pixels]

/** Where a label is: its left edge and the middle of its height [pixels]. */
export interface Place {
  x: number;
  y: number;
  width: number;
  height: number;
}

/** What is written beside a mark in the picture. */
export class Label implements Place {
  readonly element = document.createElement('span');
  x = 0;
  y = 0;
  width = 0;
  height = 0;
  private words = '';
  private measured = false;
  private point: Vector3 | null = null; // in the view
  private above = 0;

  constructor(private labels: Labels) {
    this.element.className = 'name';
  }

  write(words: string): void {
    if (this.words === words) return;
    this.words = words;
    this.measured = false;
    write_words(this.element, words);
  }

  /** Goes beside a point. @param above by how much higher than that [pixels] */
  aim(point: Vector3, camera: PerspectiveCamera, above = 0): void {
    this.point = point.project(camera);
    this.above = above;
    this.labels.add(this);
  }

  remove(): void {
    this.labels.delete(this);
  }

  /** Finds where it would be by itself. @returns whether it is in the picture */
  locate(width: number, height: number): boolean {
    const { element, point, words } = this;
    if (!point || Math.abs(point.z) > 1 || !words) return false;
    if (!this.measured) {
      element.hidden = false;
      this.width = element.offsetWidth;
      this.height = element.offsetHeight;
      this.measured = true;
    }
    this.x = label_left(((point.x + 1) / 2) * width, this.width, width);
    this.y = ((1 - point.y) / 2) * height - this.above;
    return true;
  }

  show(shown: boolean): void {
    const { element, x, y } = this;
    element.hidden = !shown;
    element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translateY(-50%)`;
  }
}

/** All that is written beside marks, none of it over another. */
export class Labels {
  private all = new Set<Label>();

  constructor(private root: HTMLElement) {}

  add(label: Label): void {
    if (this.all.has(label)) return;
    this.all.add(label);
    this.root.append(label.element);
  }

  delete(label: Label): void {
    this.all.delete(label);
    label.element.remove();
  }

  /** Puts each where it is read, in a picture of this size [pixels]. */
  arrange(width: number, height: number): void {
    const seen = [...this.all].filter((label) => label.locate(width, height));
    const placed = apart(seen, height);
    for (const label of this.all) label.show(placed.includes(label));
  }
}

/**
 * Moves labels down, and at the picture's lower edge up, so that none covers another, in the order of their heights
 * and no farther than needed.
 * @param height of the picture
 * @returns those that stay near enough to their marks
 */
export function apart<Kind extends Place>(labels: Kind[], height: number): Kind[] {
  const placed: Kind[] = [];
  const lowest: number[] = [];
  for (const label of [...labels].sort((a, b) => a.y - b.y)) {
    const y = Math.max(label.y, ...placed.map((other) => other.y + room_between(label, other)));
    if (y > label.y + MOST_SHIFT) continue;
    placed.push(label);
    lowest.push(Math.max(label.y, height - label.height / 2));
    label.y = y;
  }
  for (let k = placed.length; k--; ) {
    const label = placed[k];
    const below = placed.slice(k + 1);
    label.y = Math.min(label.y, lowest[k], ...below.map((other) => other.y - room_between(label, other)));
  }
  return placed;
}

/** How far apart the middles of two labels must be in height; none at all if they are beside each other. */
function room_between(one: Place, other: Place): number {
  const beside = one.x >= other.x + other.width + GAP || other.x >= one.x + one.width + GAP;
  return beside ? -Infinity : (one.height + other.height) / 2 + GAP;
}

/**
 * Where a label begins: to the right of a mark, or to its left where it would leave the picture. Beside a
 * mark that is itself outside it leaves the picture too.
 * @param mark where that is; all in pixels from the picture's left edge
 */
export function label_left(mark: number, label: number, picture: number): number {
  const right = mark + OFFSET;
  const fits = right + label <= picture || mark > picture;
  return fits ? right : Math.max(0, mark - OFFSET - label);
}

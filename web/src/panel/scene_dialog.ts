import { late_styles } from './late_styles.js';
import { grouped } from './scene_groups.js';
import type { Group, Scene } from './scene_groups.js';

const part = (id: string) => document.getElementById(id)!;

/** The dialog's own styles, which must have come before it is opened. */
export const styles = () => late_styles('scenes.css');

/**
 * The server's scenes in groups, with a search and a picture each. It is a bundle of its own, which
 * imports nothing of the rest, so that it is no part of the page's first load.
 */
export class SceneDialog {
  private dialog = part('scenes') as HTMLDialogElement;
  private search = part('scene-search') as HTMLInputElement;
  private list = part('scene-list');
  private scenes: Scene[] = [];
  /** Names of scenes of which there is a picture; null until they are asked for. */
  private pictures: Set<string> | null = null;
  private shown = '';

  /** @param load called with a chosen scene */
  constructor(
    private title_of: (scene: string) => string,
    private load: (scene: string) => void,
  ) {
    // Where there is no keyboard, the focus would bring one up.
    this.search.autofocus = !window.matchMedia('(pointer: coarse)').matches;
    this.dialog.addEventListener('click', ({ target }) => target === this.dialog && this.dialog.close());
    this.search.addEventListener('input', () => this.write());
    this.dialog.addEventListener('keydown', (event) => this.key(event));
  }

  open(scenes: Scene[], shown: string): void {
    if (this.dialog.open) return;
    this.search.value = '';
    this.show(scenes, shown);
    this.dialog.showModal();
    this.list.querySelector('[aria-current]')?.scrollIntoView({ block: 'nearest' });
    if (!this.pictures) void this.fetch_pictures();
  }

  /** Lists the scenes, with a mark at the one that is shown. */
  show(scenes: Scene[], shown: string): void {
    const same = scenes === this.scenes;
    this.scenes = scenes;
    this.shown = shown;
    if (same && this.dialog.open) this.mark();
    else this.write();
  }

  /** Moves the mark alone: a list that is written anew would lose the focus of who goes through it. */
  private mark(): void {
    for (const frame of this.list.querySelectorAll<HTMLElement>('i')) {
      const choice = frame.closest('button')!;
      if (frame.dataset.scene === this.shown) choice.setAttribute('aria-current', 'true');
      else choice.removeAttribute('aria-current');
    }
  }

  private async fetch_pictures(): Promise<void> {
    this.pictures = new Set();
    try {
      const response = await fetch('scenes/pictures.json');
      this.pictures = new Set((await response.json()) as string[]);
      for (const frame of this.list.querySelectorAll('i')) this.fill(frame);
    } catch {
      this.pictures = null; // asked again when the dialog is next opened
    }
  }

  private write(): void {
    const groups = grouped(this.scenes, this.search.value);
    this.list.replaceChildren(...groups.map((group) => this.section(group)));
    part('no-scene').hidden = groups.length > 0 || this.scenes.length === 0;
  }

  private section({ title, scenes }: Group): HTMLElement {
    const section = document.createElement('section');
    const list = document.createElement('ul');
    list.append(...scenes.map((scene) => this.entry(scene)));
    section.append(text_element('h3', title), list);
    return section;
  }

  private entry({ name, description }: Scene): HTMLElement {
    const choice = document.createElement('button');
    choice.type = 'button';
    choice.append(this.picture(name), text_element('b', this.title_of(name)), text_element('span', description));
    if (name === this.shown) choice.setAttribute('aria-current', 'true');
    choice.addEventListener('click', () => {
      this.dialog.close();
      this.load(name);
    });
    const item = document.createElement('li');
    item.append(choice);
    return item;
  }

  private picture(name: string): HTMLElement {
    const frame = text_element('i', '');
    frame.dataset.scene = name;
    this.fill(frame);
    return frame;
  }

  private fill(frame: HTMLElement): void {
    const { scene } = frame.dataset;
    if (!scene || !this.pictures?.has(scene)) return;
    const picture = document.createElement('img');
    picture.loading = 'lazy'; // before the source, or it would be fetched at once
    picture.alt = '';
    picture.src = `scenes/${scene}.jpg`;
    frame.replaceChildren(picture);
  }

  /** Arrows go from scene to scene, and Enter in the search takes the first. */
  private key(event: KeyboardEvent): void {
    const choices = [...this.list.querySelectorAll<HTMLElement>('button')];
    const searching = document.activeElement === this.search;
    if (searching && event.key === 'Enter') {
      event.preventDefault();
      choices[0]?.click();
      return;
    }
    const from = choices.indexOf(document.activeElement as HTMLElement);
    const to = from < 0 ? searching && event.key === 'ArrowDown' && choices[0] : neighbour(choices, from, event.key);
    if (!to) return;
    event.preventDefault();
    to.focus();
  }
}

/** The choice that an arrow key leads to; none at the ends. */
function neighbour(choices: HTMLElement[], from: number, key: string): HTMLElement | undefined {
  if (key === 'ArrowRight') return choices[from + 1];
  if (key === 'ArrowLeft') return choices[from - 1];
  if (key !== 'ArrowDown' && key !== 'ArrowUp') return undefined;
  const place = (choice: HTMLElement) => choice.getBoundingClientRect();
  const { left, top } = place(choices[from]);
  const down = key === 'ArrowDown';
  const beyond = choices.filter((choice) => (down ? place(choice).top > top + 1 : place(choice).top < top - 1));
  const next_row = (down ? Math.min : Math.max)(...beyond.map((choice) => place(choice).top));
  const row = beyond.filter((choice) => Math.abs(place(choice).top - next_row) < 1);
  return row.sort((a, b) => Math.abs(place(a).left - left) - Math.abs(place(b).left - left))[0];
}

function text_element(tag: string, text: string): HTMLElement {
  const made = document.createElement(tag);
  made.textContent = text;
  return made;
}

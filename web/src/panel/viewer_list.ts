import type { Viewer } from '../../../proto/js/messages.js';
import { name_element } from '../view/words.js';
import { element } from './element.js';

const MOST_NAMES = 6;
const SMALL = '(width <= 600px), (height <= 480px)'; // as in screens.css; several people are only counted there

/** Who is here, in short. Its buttons open the list of people, and stay the same, as does the focus upon them. */
export class ViewerList {
  private list = element('viewers');
  private own = new Opener(); // the own name, or on a small screen how many are here
  private more = new Opener();
  private viewers: Viewer[] = [];
  private own_id = 0;
  private small = window.matchMedia(SMALL);

  constructor() {
    this.small.addEventListener('change', () => this.write());
  }

  show(viewers: Viewer[], own: number): void {
    this.viewers = [...viewers].sort((a, b) => Number(b.id === own) - Number(a.id === own));
    this.own_id = own;
    this.write();
  }

  private write(): void {
    const { viewers, own, more } = this;
    if (this.small.matches && viewers.length > 1) return this.arrange([own.count(`${viewers.length} people`)]);
    const shown = viewers.slice(0, MOST_NAMES);
    const items = shown.map((viewer) => (viewer.id === this.own_id ? own.name(viewer) : entry(viewer)));
    const others = viewers.length - items.length;
    this.arrange(others > 0 ? [...items, more.count(`and ${others} more`)] : items);
  }

  /** What is in its place stays there, for what is put there anew has lost the focus. */
  private arrange(items: Element[]): void {
    const { children } = this.list;
    for (const item of [...children]) if (!items.includes(item)) item.remove();
    for (const [k, item] of items.entries())
      if (children[k] !== item) this.list.insertBefore(item, children[k] ?? null);
  }
}

/** An entry that is a button, which opens the list of people. */
class Opener {
  readonly item = document.createElement('li');
  private swatch = span('swatch', '');
  private button = document.createElement('button');
  private told = '';

  constructor() {
    this.button.type = 'button';
    this.item.append(this.swatch, this.button);
  }

  /** The own name, which can be changed. */
  name({ name, color }: Viewer): HTMLElement {
    this.swatch.hidden = false;
    this.item.style.setProperty('--color', color);
    return this.write('Change your name', name, name_element(name), span('you', ' (you)'));
  }

  count(words: string): HTMLElement {
    this.swatch.hidden = true;
    return this.write('Who is here', words, words);
  }

  private write(title: string, told: string, ...parts: (HTMLElement | string)[]): HTMLElement {
    if (this.button.title === title && this.told === told) return this.item;
    this.told = told;
    this.button.title = title;
    this.button.replaceChildren(...parts);
    return this.item;
  }
}

/** Another viewer. */
function entry({ name, color }: Viewer): HTMLElement {
  const item = document.createElement('li');
  item.append(span('swatch', ''), name_element(name));
  item.style.setProperty('--color', color);
  return item;
}

function span(name: string, text: string): HTMLElement {
  const made = document.createElement('span');
  made.className = name;
  made.textContent = text;
  return made;
}

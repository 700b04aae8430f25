import { element } from './element.js';
import { remember, remembered } from './preferences.js';

/** A button that opens and closes a part of the page, which this browser remembers. */
export class Disclosure {
  private button: HTMLElement;
  private part: HTMLElement;

  /**
   * @param id       of the button; `aria-controls` names the part
   * @param at_first whether it is open where nothing is remembered
   * @param changed  called after each change
   */
  constructor(
    private id: string,
    at_first: boolean,
    private changed: (open: boolean) => void = () => {},
  ) {
    this.button = element(id);
    this.part = element(this.button.getAttribute('aria-controls')!);
    this.button.addEventListener('click', () => this.toggle());
    const last = remembered(id);
    this.show(last === null ? at_first : last === 'open');
  }

  get open(): boolean {
    return !this.part.hidden;
  }

  toggle(): void {
    this.show(!this.open);
    remember(this.id, this.open ? 'open' : 'closed');
  }

  private show(open: boolean): void {
    this.part.hidden = !open;
    this.button.setAttribute('aria-expanded', String(open));
    this.changed(open);
  }
}

import { element } from './element.js';
import { remember, remembered } from './preferences.js';

/** Tells at the first visit that the cloth can be taken, until it is. */
export class Hint {
  private line = element('hint');

  constructor() {
    this.line.hidden = remembered('taken') !== null;
    const finger = window.matchMedia('(pointer: coarse)').matches;
    element('hint-text').textContent = finger
      ? 'Take the cloth: touch it and pull'
      : 'Take the cloth: drag it with the mouse';
  }

  /** The cloth has been taken. */
  done(): void {
    if (this.line.hidden) return;
    this.line.hidden = true;
    remember('taken', 'yes');
  }
}

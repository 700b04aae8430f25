import { element } from './element.js';
import { remember, remembered } from './preferences.js';

/** Tells who may take the cloth at the first visit that it can be taken, until it is. */
export class Hint {
  private line = element('hint');
  private taken = remembered('taken') !== null;

  constructor() {
    const finger = window.matchMedia('(pointer: coarse)').matches;
    element('hint-text').textContent = finger
      ? 'Take the cloth: touch it and pull'
      : 'Take the cloth: drag it with the mouse';
  }

  /** @param may_hold whether the viewer may take the cloth */
  offer(may_hold: boolean): void {
    this.line.hidden = this.taken || !may_hold;
  }

  /** The cloth has been taken. */
  done(): void {
    if (this.taken) return;
    this.taken = this.line.hidden = true;
    remember('taken', 'yes');
  }
}

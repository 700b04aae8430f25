import { element } from './element.js';

/** The controls that have no place in the toolbar of a small screen, behind a button of it. */
export class Drawer {
  private toolbar = element('toolbar');
  private button = element('more');

  constructor() {
    this.button.addEventListener('click', () => this.show(!('open' in this.toolbar.dataset)));
    element('view').addEventListener('pointerdown', () => this.show(false));
  }

  private show(open: boolean): void {
    this.toolbar.toggleAttribute('data-open', open);
    this.button.setAttribute('aria-expanded', String(open));
  }
}

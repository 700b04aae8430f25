import { element } from './element.js';

/** Full screen, and a picture without panels. */
export class WindowTools {
  private full_screen = element('full-screen');
  private back = element('show-panels');

  /** @param changed called when the panels come or go */
  constructor(private changed: () => void) {
    this.full_screen.hidden = !document.fullscreenEnabled;
    this.full_screen.addEventListener('click', () => void this.toggle_full_screen());
    document.addEventListener('fullscreenchange', () => {
      this.full_screen.setAttribute('aria-pressed', String(document.fullscreenElement !== null));
    });
    element('hide').addEventListener('click', () => this.toggle_panels());
    this.back.addEventListener('click', () => this.toggle_panels());
  }

  /** Hides all panels, or shows them again. */
  toggle_panels(): void {
    const bare = document.body.toggleAttribute('data-bare');
    this.back.hidden = !bare;
    // What had the focus may be hidden now.
    element('view').focus({ preventScroll: true });
    this.changed();
  }

  private async toggle_full_screen(): Promise<void> {
    if (document.fullscreenElement) await document.exitFullscreen();
    else await document.documentElement.requestFullscreen().catch(() => {}); // the browser says why
  }
}

import { element } from './element.js';
import { remember, remembered } from './preferences.js';

export type Theme = 'light' | 'dark';

function is_theme(text: string | null): text is Theme {
  return text === 'light' || text === 'dark';
}

/**
 * Light or dark: as `?theme=` in the page's address, else as last chosen here, else as the system
 * prefers, which it then follows.
 */
export class ThemeSwitch {
  theme: Theme = 'light';
  private button = element('theme');
  private system = window.matchMedia('(prefers-color-scheme: dark)');
  private chosen: Theme | null = null;

  /** @param changed called with each theme, the first one too */
  constructor(private changed: (theme: Theme) => void) {
    const asked = new URLSearchParams(window.location.search).get('theme');
    const last = remembered('theme');
    this.chosen = is_theme(asked) ? asked : is_theme(last) ? last : null;
    this.system.addEventListener('change', () => this.show());
    this.button.addEventListener('click', () => this.toggle());
    this.show();
  }

  private toggle(): void {
    this.chosen = this.theme === 'dark' ? 'light' : 'dark';
    remember('theme', this.chosen);
    this.show();
  }

  private show(): void {
    this.theme = this.chosen ?? (this.system.matches ? 'dark' : 'light');
    const root = document.documentElement;
    root.dataset.theme = this.theme;
    this.button.setAttribute('aria-pressed', String(this.theme === 'dark'));
    const page = getComputedStyle(root).getPropertyValue('--page');
    document.querySelector('meta[name="theme-color"]')!.setAttribute('content', page);
    this.changed(this.theme);
  }
}

import type { WeftClient } from '../../../proto/js/index.js';
import type { TextileTest } from '../view/textile_marks.js';
import { element } from './element.js';

const ASK_INTERVAL = 1; // [s]

export type Measurements = Record<string, number>;

/** Which test has these measurements; null if the scene is none. */
export function test_of(measurements: Measurements): TextileTest | null {
  if ('drape_coefficient_percent' in measurements) return 'drape';
  if ('amplitude_m' in measurements) return 'decay';
  return 'chord_angle_degrees' in measurements ? 'cantilever' : null;
}

/**
 * Figures of a laboratory scene beside the published band. The server is asked until it has answered
 * once for each scene, and then every second while the scene is a test.
 */
export class LaboratoryPanel {
  private panel = element('laboratory');
  private asked_at = -Infinity;
  private asking = false;
  private known = true; // whether the scene is a test
  private scene = 0; // counts the scenes; an answer of an earlier one is too late

  /** @param changed called with the test of each scene, once known */
  constructor(
    private client: WeftClient,
    private changed: (test: TextileTest | null) => void,
  ) {
    this.panel.hidden = true;
  }

  /** Another scene, which may be a test or not. */
  renew(): void {
    this.scene += 1;
    this.known = false;
    this.panel.hidden = true;
    this.changed(null);
    void this.ask();
  }

  /** @param now [s] */
  follow(now: number): void {
    if ((this.known && this.panel.hidden) || this.asking || !this.client.connected) return;
    if (now - this.asked_at < ASK_INTERVAL) return;
    this.asked_at = now;
    void this.ask();
  }

  private async ask(): Promise<void> {
    const { scene } = this;
    this.asking = true;
    try {
      const measured = (await this.client.query('measurements')) as Measurements;
      const test = test_of(measured);
      const figures = test && (await import('./laboratory_figures.js'));
      if (scene !== this.scene) return;
      if (!this.known) this.changed(test);
      this.known = true;
      this.panel.hidden = test === null;
      figures?.write_figures(measured, test !== 'decay');
    } catch {
      // The connection was lost, or the server is busy; it is asked again.
    } finally {
      if (scene === this.scene) this.asking = false;
    }
  }
}

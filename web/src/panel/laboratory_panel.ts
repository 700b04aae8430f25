import type { WeftClient } from '../../../proto/js/index.js';
import type { TextileTest } from '../view/textile_marks.js';
import { element } from './element.js';

const ASK_INTERVAL = 1; // [s]

export type Measurements = Record<string, number>;

/** How a measurement is written: its name, the factor to its unit, the unit, and the decimals. */
const ROWS: Record<string, [string, number, string, number]> = {
  drape_coefficient_percent: ['Drape coefficient', 1, '%', 1],
  folds: ['Folds', 1, '', 0],
  droop_m: ['Droop', 100, 'cm', 2],
  chord_angle_degrees: ['Angle of the chord', 1, '°', 1],
  bending_length_m: ['Bending length', 100, 'cm', 2],
  bending_rigidity_n_m: ['Bending rigidity', 1e6, 'µN m', 2],
  amplitude_m: ['Amplitude', 1000, 'mm', 2],
  swing_period_s: ['Period', 1, 's', 3],
  decay_time_s: ['Falls to 1/e in', 1, 's', 2],
  loss_factor: ['Loss factor', 1, '', 3],
  relaxation_time_s: ['Relaxation time of bending', 1000, 'ms', 2],
  largest_speed_m_s: ['Still moving at', 1000, 'mm/s', 1],
};

export function measurement_text(name: string, value: number): { label: string; text: string } | null {
  const row = ROWS[name];
  if (!row) return null;
  const [label, factor, unit, digits] = row;
  return { label, text: `${(value * factor).toFixed(digits)} ${unit}`.trim() };
}

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
      if (scene !== this.scene) return;
      const test = test_of(measured);
      if (!this.known) this.changed(test);
      this.known = true;
      this.panel.hidden = test === null;
      if (test) this.write(measured);
    } catch {
      // The connection was lost, or the server is busy; it is asked again.
    } finally {
      if (scene === this.scene) this.asking = false;
    }
  }

  private write(measured: Measurements): void {
    const rows = Object.entries(measured).flatMap(([name, value]) => {
      const told = measurement_text(name, value);
      if (!told) return [];
      const row = document.createElement('div');
      const [label, text] = [document.createElement('dt'), document.createElement('dd')];
      label.textContent = told.label;
      text.textContent = told.text;
      row.append(label, text);
      return [row];
    });
    element('laboratory-figures').replaceChildren(...rows);
    element('laboratory-note').hidden = test_of(measured) === 'decay'; // which has no lines
    this.write_band(measured);
  }

  /** The published band of the drape coefficient, and where this cloth is. */
  private write_band(measured: Measurements): void {
    const { published_low_percent: low, published_high_percent: high } = measured;
    const part = element('published');
    part.hidden = low === undefined || high === undefined;
    if (part.hidden) return;
    const at = measured.drape_coefficient_percent;
    const inside = at >= low && at <= high;
    element('published-text').textContent =
      `Published: ${low.toFixed(0)} to ${high.toFixed(0)} %` + (inside ? ', so it agrees' : '');
    const band = element('published-band');
    for (const [name, value] of Object.entries({ low, high, at })) {
      band.style.setProperty(`--${name}`, String(value));
    }
  }
}

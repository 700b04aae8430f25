import { element } from './element.js';
import type { Measurements } from './laboratory_panel.js';

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

/** Writes a test's figures into its panel. @param has_lines whether the picture shows where they are measured */
export function write_figures(measured: Measurements, has_lines: boolean): void {
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
  element('laboratory-note').hidden = !has_lines;
  write_band(measured);
}

/** The published band of the drape coefficient, and where this cloth is. */
function write_band(measured: Measurements): void {
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

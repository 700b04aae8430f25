import type { Energy } from '../../../proto/js/messages.js';

export const WINDOW = 10; // of simulated time [s]

/** What is drawn of the cloth's energy at one moment [J]. */
export interface Moment {
  /** Simulated time [s]. */
  time: number;
  motion: number;
  /** Stretched and bent fabric. */
  fabric: number;
  /** Work that gravity can still do; absolute, so only differences mean something. */
  height: number;
}

/** The energy of the last ten seconds of simulated time. */
export class EnergyHistory {
  moments: Moment[] = [];

  add(time: number, { kinetic, stretch, bending, gravity }: Energy): void {
    const last = this.moments.at(-1);
    if (last && time < last.time) this.moments = []; // the scene starts anew
    const moment = { time, motion: kinetic, fabric: stretch + bending, height: gravity };
    if (last?.time === time) this.moments.pop();
    this.moments.push(moment);
    while (time - this.moments[0].time > WINDOW) this.moments.shift();
  }

  /** The moments, each height above the lowest of them, and the largest of all values [J]. */
  shown(): { moments: Moment[]; largest: number } {
    const lowest = Math.min(...this.moments.map(({ height }) => height));
    const moments = this.moments.map((moment) => ({ ...moment, height: moment.height - lowest }));
    const values = moments.flatMap(({ motion, fabric, height }) => [motion, fabric, height]);
    return { moments, largest: Math.max(0, ...values) };
  }
}

/** An energy [J] with three digits and a unit that suits it. */
export function energy_text(joules: number): string {
  const [factor, unit] = joules >= 1 ? [1, 'J'] : joules >= 1e-3 ? [1e3, 'mJ'] : [1e6, 'µJ'];
  const value = joules * factor;
  return `${value.toFixed(value < 10 ? 2 : value < 100 ? 1 : 0)} ${unit}`;
}

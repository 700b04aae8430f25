import type { State } from '../../../proto/js/messages.js';
import { element } from './element.js';
import { energy_text, EnergyHistory, WINDOW } from './energy_history.js';
import type { Moment } from './energy_history.js';

type Line = Exclude<keyof Moment, 'time'>;
const LINES: Line[] = ['height', 'fabric', 'motion'];
const LINE_WIDTH = 1.6; // [pixels]

/** A strip chart of the cloth's energy, with the present values beside its lines' names. */
export class EnergyChart {
  private canvas = element<HTMLCanvasElement>('energy-chart');
  private history = new EnergyHistory();

  add(state: State): void {
    this.history.add(state.time, state.energy);
    this.draw();
  }

  clear(): void {
    this.history = new EnergyHistory();
    this.draw();
  }

  /** Draws if anybody can see it. */
  draw(): void {
    const { canvas } = this;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (width === 0) return;
    const { moments, largest } = this.history.shown();
    const last = moments.at(-1);
    for (const line of LINES) {
      element(`energy-${line}`).textContent = last ? energy_text(last[line]) : '–';
    }
    element('energy-top').textContent = largest > 0 ? energy_text(largest) : '';
    const ratio = window.devicePixelRatio;
    [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    const context = canvas.getContext('2d')!;
    context.scale(ratio, ratio);
    context.lineWidth = LINE_WIDTH;
    context.lineJoin = 'round';
    if (!last || largest === 0) return;
    const style = getComputedStyle(canvas);
    for (const line of LINES) {
      context.strokeStyle = style.getPropertyValue(`--${line}`);
      context.beginPath();
      for (const moment of moments) {
        const x = width * (1 - (last.time - moment.time) / WINDOW);
        const y = height - 1 - (height - 2) * (moment[line] / largest);
        context.lineTo(x, y);
      }
      context.stroke();
    }
  }
}

import { element } from './element.js';

const SEND_INTERVAL = 60; // between values of a moving slider [ms]
const QUIET_TIME = 600; // in which what the server tells does not set a slider just moved [ms]

/** How a slider's place and a value belong together, and how the value is written. */
export interface Scale {
  value(place: number): number;
  place(value: number): number;
  text(value: number): string;
}

/** A scale on which the place is the value. */
export function linear(unit: string): Scale {
  const same = (number: number) => number;
  return { value: same, place: same, text: (value) => `${value.toFixed(1)} ${unit}` };
}

/** Powers of two, by their exponent; those below one are written as fractions. */
export const POWERS_OF_TWO: Scale = {
  value: (place) => 2 ** place,
  place: (value) => Math.log2(value),
  text(value) {
    const parts = 1 / value;
    if (value < 1 && Number.isInteger(parts)) return `1/${parts} ×`;
    return `${Number.isInteger(value) ? value : value.toFixed(2)} ×`;
  },
};

/** A slider for a setting of the server, and the text of its value. */
export class Slider {
  private input: HTMLInputElement;
  private output: HTMLElement;
  private timer = 0;
  private quiet = 0; // a timer, while what the server tells waits
  private told = 0; // by the server
  private news = false; // told in the quiet time, and not shown

  constructor(
    id: string,
    private scale: Scale,
    private send: (value: number) => Promise<unknown>,
  ) {
    this.input = element<HTMLInputElement>(id);
    this.output = element(`${id}-value`);
    this.input.addEventListener('input', () => this.moved());
  }

  /** Shows the server's present value; that of a slider just moved a little later. */
  show(value: number): void {
    this.told = value;
    this.news = this.quiet > 0;
    if (!this.news) this.show_told();
  }

  /** Moves by steps of the slider, as a key does. */
  step(count: number): void {
    if (this.input.disabled) return;
    this.input.stepUp(count);
    this.moved();
  }

  private get value(): number {
    return this.scale.value(this.input.valueAsNumber);
  }

  private moved(): void {
    window.clearTimeout(this.quiet);
    this.quiet = window.setTimeout(() => this.end_quiet(), QUIET_TIME);
    this.write(this.value);
    if (this.timer) return;
    this.timer = window.setTimeout(() => {
      this.timer = 0;
      this.send(this.value).catch(() => this.end_quiet(true)); // refused, it is as it was
    }, SEND_INTERVAL);
  }

  private end_quiet(refused = false): void {
    window.clearTimeout(this.quiet);
    this.quiet = 0;
    if (refused || this.news) this.show_told();
  }

  private show_told(): void {
    this.news = false;
    this.input.value = String(this.scale.place(this.told));
    this.write(this.told);
  }

  private write(value: number): void {
    const text = this.scale.text(value);
    if (this.output.textContent !== text) this.output.textContent = text;
    this.input.setAttribute('aria-valuetext', text);
  }
}

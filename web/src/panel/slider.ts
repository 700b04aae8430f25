import { element } from './element.js';

const SEND_INTERVAL = 60; // between values of a moving slider [ms]
const QUIET_TIME = 600; // in which the state does not set a slider just moved [ms]

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
  private moved_at = -Infinity;

  constructor(
    id: string,
    private scale: Scale,
    private send: (value: number) => void,
  ) {
    this.input = element<HTMLInputElement>(id);
    this.output = element(`${id}-value`);
    this.input.addEventListener('input', () => this.moved());
  }

  /** Shows the server's present value. */
  show(value: number): void {
    if (performance.now() - this.moved_at < QUIET_TIME) return;
    this.input.value = String(this.scale.place(value));
    this.write(value);
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
    this.moved_at = performance.now();
    this.write(this.value);
    if (this.timer) return;
    this.timer = window.setTimeout(() => {
      this.timer = 0;
      this.send(this.value);
    }, SEND_INTERVAL);
  }

  private write(value: number): void {
    const text = this.scale.text(value);
    if (this.output.textContent !== text) this.output.textContent = text;
    this.input.setAttribute('aria-valuetext', text);
  }
}

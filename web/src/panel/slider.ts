import { element } from './element.js';

const SEND_INTERVAL = 60; // between values of a moving slider [ms]
const QUIET_TIME = 600; // in which the state does not set a slider just moved [ms]

/** A slider for a setting of the server, and the text of its value. */
export class Slider {
  private input: HTMLInputElement;
  private output: HTMLElement;
  private timer = 0;
  private moved_at = -Infinity;

  constructor(
    id: string,
    private unit: string,
    private send: (value: number) => void,
  ) {
    this.input = element<HTMLInputElement>(id);
    this.output = element(`${id}-value`);
    this.input.addEventListener('input', () => this.moved());
  }

  /** Shows the server's present value. */
  show(value: number): void {
    if (performance.now() - this.moved_at < QUIET_TIME) return;
    this.input.value = String(value);
    this.write(value);
  }

  private moved(): void {
    this.moved_at = performance.now();
    this.write(this.input.valueAsNumber);
    if (this.timer) return;
    this.timer = window.setTimeout(() => {
      this.timer = 0;
      this.send(this.input.valueAsNumber);
    }, SEND_INTERVAL);
  }

  private write(value: number): void {
    const text = `${value.toFixed(1)} ${this.unit}`;
    if (this.output.textContent !== text) this.output.textContent = text;
    this.input.setAttribute('aria-valuetext', text);
  }
}

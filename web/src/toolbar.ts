import type { WeftClient } from '../../proto/js/index.js';
import type { State, Vec3 } from '../../proto/js/messages.js';
import { tell_refusal } from './connection.js';
import type { HandMode } from './hold.js';
import { element } from './panels.js';
import { SceneList } from './scene_list.js';

const SEND_INTERVAL = 60; // between values of a slider that moves [ms]
const QUIET_TIME = 600; // in which a slider just moved is not set by the state [ms]

/** Buttons, the list of scenes, and the sliders of the air and of gravity. */
export class Toolbar {
  private pause = element<HTMLButtonElement>('pause');
  private step = element<HTMLButtonElement>('step');
  private scenes: SceneList;
  private sling = element<HTMLButtonElement>('sling');
  private help = element<HTMLDialogElement>('help');
  private wind: VectorSlider;
  private gravity: VectorSlider;
  private paused = false;

  /** @param tell shows a sentence to the user */
  constructor(
    private client: WeftClient,
    private tell: (message: string) => void,
    frame: () => void,
  ) {
    this.wind = new VectorSlider('wind', 'm/s', [0, 0, -1], (wind) => this.run(client.set({ wind })));
    this.gravity = new VectorSlider('gravity', 'm/s²', [0, -1, 0], (gravity) =>
      this.run(client.set({ gravity })),
    );
    this.pause.addEventListener('click', () => this.toggle_pause());
    this.step.addEventListener('click', () => this.one_step());
    element('reset').addEventListener('click', () => this.reset());
    this.sling.addEventListener('click', () => this.toggle_sling());
    element('frame').addEventListener('click', frame);
    element('help-button').addEventListener('click', () => this.show_help());
    this.help.addEventListener('click', (event) => event.target === this.help && this.help.close());
    this.scenes = new SceneList((scene) => this.run(client.load(scene)));
    this.enable(false);
  }

  /** Without a connection nothing can be asked for. */
  enable(connected: boolean): void {
    for (const id of ['pause', 'step', 'reset', 'scene', 'wind', 'gravity']) {
      element<HTMLButtonElement>(id).disabled = !connected;
    }
    if (connected) void this.scenes.fetch();
  }

  state(state: State): void {
    this.paused = state.paused;
    this.pause.setAttribute('aria-pressed', String(state.paused));
    const action = state.paused ? 'Resume' : 'Pause';
    this.pause.setAttribute('aria-label', action);
    this.pause.title = `${action} (Space)`;
    this.wind.show(state.wind);
    this.gravity.show(state.gravity);
    this.scenes.choose(state.scene);
  }

  toggle_pause(): void {
    this.run(this.paused ? this.client.resume() : this.client.pause());
  }

  /** One tick; a room that runs is paused by it. */
  one_step(): void {
    if (this.paused) this.run(this.client.step());
    else this.run(this.client.pause());
  }

  reset(): void {
    this.run(this.client.reset());
  }

  /** How the hand takes hold. */
  get hand_mode(): HandMode {
    return this.sling.getAttribute('aria-pressed') === 'true' ? 'sling' : 'live';
  }

  toggle_sling(): void {
    this.sling.setAttribute('aria-pressed', String(this.hand_mode === 'live'));
  }

  show_scenes(): void {
    this.scenes.open();
  }

  show_help(): void {
    if (!this.help.open) this.help.showModal();
  }

  private run(answer: Promise<unknown>): void {
    tell_refusal(answer, this.tell);
  }
}

/** A slider for the length of a vector, whose direction stays. */
class VectorSlider {
  private input: HTMLInputElement;
  private output: HTMLElement;
  private timer = 0;
  private moved_at = -Infinity;

  constructor(
    id: string,
    private unit: string,
    private direction: Vec3,
    private send: (value: Vec3) => void,
  ) {
    this.input = element<HTMLInputElement>(id);
    this.output = element(`${id}-value`);
    this.input.addEventListener('input', () => this.moved());
  }

  /** What the server has now. */
  show(value: Vec3): void {
    const length = Math.hypot(...value);
    if (length > 1e-9) this.direction = value.map((part) => part / length) as Vec3;
    if (performance.now() - this.moved_at < QUIET_TIME) return;
    this.input.value = String(length);
    this.write(length);
  }

  private moved(): void {
    this.moved_at = performance.now();
    this.write(this.input.valueAsNumber);
    if (this.timer) return;
    this.timer = window.setTimeout(() => {
      this.timer = 0;
      const length = this.input.valueAsNumber;
      this.send(this.direction.map((part) => part * length) as Vec3);
    }, SEND_INTERVAL);
  }

  private write(length: number): void {
    const text = `${length.toFixed(1)} ${this.unit}`;
    if (this.output.textContent !== text) this.output.textContent = text;
    this.input.setAttribute('aria-valuetext', text);
  }
}

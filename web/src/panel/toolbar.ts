import type { WeftClient } from '../../../proto/js/index.js';
import type { Fan, State, Vec3 } from '../../../proto/js/messages.js';
import { tell_refusal } from '../wire/connection.js';
import type { HandMode } from '../hold/hold.js';
import { Drawer } from './drawer.js';
import { element } from './element.js';
import { SceneList } from './scene_list.js';
import { linear, POWERS_OF_TWO, Slider } from './slider.js';

function scaled(direction: Vec3, length: number): Vec3 {
  return direction.map((part) => part * length) as Vec3;
}

function direction_of(vector: Vec3): Vec3 | null {
  const length = Math.hypot(...vector);
  return length > 1e-9 ? scaled(vector, 1 / length) : null;
}

// What asks something of the server.
const ASKING = 'pause step reset fan boxes scene speed wind gravity fan-speed'.split(' ');

/** Buttons, the list of scenes, and the sliders of the air and of gravity. */
export class Toolbar {
  private pause = element<HTMLButtonElement>('pause');
  private step = element<HTMLButtonElement>('step');
  private scenes: SceneList;
  private fan = element<HTMLButtonElement>('fan');
  private sling = element<HTMLButtonElement>('sling');
  private objects = element<HTMLButtonElement>('objects');
  private help = element<HTMLDialogElement>('help');
  private speed: Slider;
  private wind: Slider;
  private gravity: Slider;
  private fan_speed: Slider;
  // Directions of wind and gravity for when a slider raises them from zero.
  private wind_direction: Vec3 = [0, 0, -1];
  private gravity_direction: Vec3 = [0, -1, 0];
  private fans: Fan[] = [];
  private paused = false;

  /** @param tell shows a sentence to the user */
  constructor(
    private client: WeftClient,
    private tell: (message: string) => void,
    private view: { frame(): void; fan(): Fan },
  ) {
    this.speed = new Slider('speed', POWERS_OF_TWO, (speed) => this.run(client.speed(speed)));
    this.wind = new Slider('wind', linear('m/s'), (length) =>
      this.run(client.set({ wind: scaled(this.wind_direction, length) })),
    );
    this.gravity = new Slider('gravity', linear('m/s²'), (length) =>
      this.run(client.set({ gravity: scaled(this.gravity_direction, length) })),
    );
    this.fan_speed = new Slider('fan-speed', linear('m/s'), (speed) =>
      this.run(client.set({ fans: this.fans.map((fan) => ({ ...fan, speed })) })),
    );
    this.pause.addEventListener('click', () => this.toggle_pause());
    this.step.addEventListener('click', () => this.one_step());
    element('reset').addEventListener('click', () => this.reset());
    this.fan.addEventListener('click', () => this.toggle_fan());
    this.sling.addEventListener('click', () => this.toggle_sling());
    this.objects.addEventListener('click', () => this.toggle_objects());
    element('frame').addEventListener('click', () => view.frame());
    element('help-button').addEventListener('click', () => this.show_help());
    this.help.addEventListener('click', (event) => event.target === this.help && this.help.close());
    this.scenes = new SceneList((scene) => this.run(client.load(scene)));
    new Drawer();
    this.enable(false);
  }

  /** Disables the controls without a connection. */
  enable(connected: boolean): void {
    for (const id of ASKING) {
      element<HTMLButtonElement>(id).disabled = !connected;
    }
    if (connected) void this.scenes.fetch();
  }

  state(state: State): void {
    this.paused = state.paused;
    this.pause.toggleAttribute('data-paused', state.paused); // to be seen; heard is the name alone
    const action = state.paused ? 'Resume' : 'Pause';
    this.pause.setAttribute('aria-label', action);
    this.pause.title = `${action} (Space)`;
    this.wind_direction = direction_of(state.wind) ?? this.wind_direction;
    this.gravity_direction = direction_of(state.gravity) ?? this.gravity_direction;
    this.speed.show(state.speed);
    this.wind.show(Math.hypot(...state.wind));
    this.gravity.show(Math.hypot(...state.gravity));
    this.scenes.choose(state.scene);
    this.show_fans(state.fans);
  }

  toggle_pause(): void {
    this.run(this.paused ? this.client.resume() : this.client.pause());
  }

  /** One tick; pauses a running room. */
  one_step(): void {
    if (this.paused) this.run(this.client.step());
    else this.run(this.client.pause());
  }

  /** Doubles the speed of time, or halves it. @param steps 1 or -1 */
  change_speed(steps: number): void {
    this.speed.step(steps);
  }

  reset(): void {
    this.run(this.client.reset());
  }

  /** Puts a fan beside the line of sight, or removes all fans. */
  toggle_fan(): void {
    this.run(this.client.set({ fans: this.fans.length ? [] : [this.view.fan()] }));
  }

  private show_fans(fans: Fan[]): void {
    this.fans = fans;
    this.fan.setAttribute('aria-pressed', String(fans.length > 0));
    element('fan-field').hidden = fans.length === 0;
    if (fans.length) this.fan_speed.show(Math.max(...fans.map(({ speed = 0 }) => speed)));
  }

  /** The hand's mode of holding. */
  get hand_mode(): HandMode {
    return this.sling.getAttribute('aria-pressed') === 'true' ? 'sling' : 'live';
  }

  toggle_sling(): void {
    this.sling.setAttribute('aria-pressed', String(this.hand_mode === 'live'));
  }

  /** Whether the hand moves objects too. */
  get moves_objects(): boolean {
    return this.objects.getAttribute('aria-pressed') === 'true';
  }

  toggle_objects(): void {
    this.objects.setAttribute('aria-pressed', String(!this.moves_objects));
  }

  show_scenes(): void {
    void this.scenes.open();
  }

  show_help(): void {
    if (!this.help.open) this.help.showModal();
  }

  private run(answer: Promise<unknown>): Promise<unknown> {
    tell_refusal(answer, this.tell);
    return answer;
  }
}

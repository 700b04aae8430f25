import type { Roster, State } from '../../../proto/js/messages.js';
import { write_words } from '../view/words.js';
import type { Refusal } from '../wire/connection.js';
import { Disclosure } from './disclosure.js';
import { element } from './element.js';
import { EnergyChart } from './energy_chart.js';
import { crossings_text, guarantee_text, reasons_text } from './guarantee.js';
import { ViewerList } from './viewer_list.js';

const TOAST_TIME = 4000; // [ms]
const WIDE = '(width >= 1600px) and (height >= 720px)'; // where figures do not cover the cloth
const RATE_WINDOW = 2; // window of the tick rate [s]

export type Phase = 'closed' | 'connecting' | 'open' | 'waiting';

/** Connection, measurements, viewers and notices. */
export class Panels {
  private toast_timer = 0;
  private phase: Phase = 'connecting';
  private refusal: Refusal | null = null;
  private viewers = new ViewerList();
  private ticks: { tick: number; time: number }[] = [];
  private energy = new EnergyChart();
  private figures = new Disclosure('figures', window.matchMedia(WIDE).matches, () => this.energy.draw());

  toggle_figures(): void {
    this.figures.toggle();
  }

  connection(phase: Phase): void {
    // Each attempt to come back is part of the loss, which is told once.
    if (phase === 'connecting' && this.phase === 'waiting') return;
    this.phase = phase;
    this.show_phase();
    if (phase === 'open') return;
    this.ticks = [];
    for (const id of ['tick-rate', 'real-time', 'step-time', 'latency']) set_text(id, '–');
    for (const id of ['guarantee', 'reasons', 'crossings', 'asleep']) element(id).hidden = true;
    this.roster({ viewers: [] }, 0);
  }

  /** Shows the server's reason for refusing the page while it does. */
  refused(refusal: Refusal | null): void {
    this.refusal = refusal;
    const told = element('refusal');
    told.hidden = refusal === null;
    set_text('refusal-message', sentence(refusal?.message ?? ''));
    set_text('refusal-hint', sentence(refusal?.hint ?? ''));
    this.show_phase();
  }

  /** Says that the picture is away, as while a phone or a driver has taken the graphics back. */
  picture_lost(away: boolean): void {
    element('picture-lost').hidden = !away;
  }

  private show_phase(): void {
    const words: Record<Phase, string> = {
      connecting: 'Connecting',
      open: 'Connected',
      waiting: 'Reconnecting',
      closed: 'Disconnected',
    };
    element('connection').dataset.phase = this.refusal ? 'closed' : this.phase;
    set_text('connection-text', this.refusal ? 'Refused' : words[this.phase]);
  }

  state(state: State): void {
    set_text('real-time', state.paused ? '0.00' : state.real_time_factor.toFixed(2));
    set_text('step-time', state.step_ms.toFixed(state.step_ms < 10 ? 2 : 0));
    this.reduced('pace', state.pace);
    this.reduced('softness', state.softness);
    const asleep = state.sleeping.cloths.length;
    element('asleep').hidden = asleep === 0;
    set_text('asleep', asleep === 1 ? 'At rest' : `${asleep} cloths at rest`);
    this.guarantee(state);
    this.strain(state);
    this.energy.add(state);
    if (!state.paused) return;
    this.ticks = [];
    set_text('tick-rate', '0');
  }

  private guarantee({ guarantee, crossings }: State): void {
    const line = element('guarantee');
    line.hidden = false;
    line.dataset.state = guarantee.state;
    set_text('guarantee-text', guarantee_text(guarantee));
    const reasons = reasons_text(guarantee);
    element('reasons').hidden = reasons === '';
    set_text('reasons', reasons);
    const counted = element('crossings');
    counted.hidden = crossings === null;
    if (!crossings) return;
    counted.dataset.crossed = String(crossings.count > 0);
    set_text('crossings', crossings_text(crossings));
  }

  private strain({ strain: { largest, p99 } }: State): void {
    const percent = (part: number) => `${(part * 100).toPrecision(2)} %`;
    set_text('strain', `Stretched or squeezed by up to ${percent(largest)}`);
    set_text('strain-p99', `99 of 100 threads by less than ${percent(p99)}`);
  }

  /** Draws again in the colours of another theme. */
  recolor(): void {
    this.energy.draw();
  }

  /** Shows a reduced value as long as it is reduced. */
  private reduced(id: string, part: number): void {
    element(id).closest('div')!.hidden = part >= 1;
    set_text(id, String(part));
  }

  /** Counts ticks by the server's clock [s], which a slow page does not affect. */
  tick(tick: number, time: number): void {
    const last = this.ticks.at(-1);
    if (last && tick < last.tick) this.ticks = [];
    this.ticks.push({ tick, time });
    while (this.ticks.length > 2 && time - this.ticks[0].time > RATE_WINDOW) this.ticks.shift();
    const [first] = this.ticks;
    const passed = time - first.time;
    if (passed > 0.5) set_text('tick-rate', ((tick - first.tick) / passed).toFixed(0));
  }

  /** @param seconds from a hand's movement to the picture; null while there is none to measure */
  latency(seconds: number | null): void {
    element('latency').closest('div')!.hidden = seconds === null;
    set_text('latency', seconds === null ? '–' : (seconds * 1000).toFixed(0));
  }

  roster({ viewers }: Pick<Roster, 'viewers'>, own: number): void {
    this.viewers.show(viewers, own);
  }

  tell(message: string): void {
    const toast = element('toast');
    write_words(toast, message);
    toast.hidden = false;
    window.clearTimeout(this.toast_timer);
    this.toast_timer = window.setTimeout(() => (toast.hidden = true), TOAST_TIME);
  }
}

function set_text(id: string, text: string): void {
  const target = element(id);
  if (target.textContent !== text) target.textContent = text;
}

/** Makes a full sentence: the server's messages start in lower case, without a final stop. */
function sentence(text: string): string {
  if (!text) return '';
  return `${text[0].toUpperCase()}${text.slice(1)}${/[.!?]$/.test(text) ? '' : '.'}`;
}

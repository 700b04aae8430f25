import type { WeftClient } from '../../../proto/js/index.js';
import { tell_refusal } from '../wire/connection.js';
import { without_unseen } from '../wire/names.js';
import { element } from './element.js';
import { remember, remembered } from './preferences.js';

const LONGEST_NAME = 32; // [characters]

function cleaned(name: string): string {
  const seen = without_unseen(name, '').trim();
  return [...seen].slice(0, LONGEST_NAME).join('').trim();
}

/** The viewer's name as `?name=` in the page's address says, else as last typed here; may be empty. */
export function own_name(): string {
  const asked = new URLSearchParams(window.location.search).get('name');
  return cleaned(asked ?? remembered('name') ?? '');
}

/** The dialog in which a viewer types a name; the own entry of the viewers opens it. */
export class NameDialog {
  private dialog = element<HTMLDialogElement>('name-dialog');
  private input = element<HTMLInputElement>('own-name');

  constructor(
    private client: WeftClient,
    private tell: (message: string) => void,
  ) {
    element('viewers').addEventListener('click', ({ target }) => {
      if (target instanceof Element && target.closest('button')) this.open();
    });
    this.dialog.addEventListener('click', ({ target }) => target === this.dialog && this.dialog.close());
    element('name-form').addEventListener('submit', () => this.use(cleaned(this.input.value)));
  }

  private open(): void {
    this.input.value = this.client.options.name ?? '';
    this.dialog.showModal();
  }

  private use(name: string): void {
    if (!name) return;
    remember('name', name);
    this.client.options.name = name; // also where there is no connection now
    tell_refusal(this.client.hello({ name }), this.tell);
  }
}

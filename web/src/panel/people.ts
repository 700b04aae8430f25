import type { WeftClient } from '../../../proto/js/index.js';
import type { State, Viewer } from '../../../proto/js/messages.js';
import { named, write_words } from '../view/words.js';
import type { Company } from '../wire/company.js';
import { tell_refusal } from '../wire/connection.js';
import { link_with, own_room } from '../wire/own_address.js';
import { element } from './element.js';
import type { PeopleList } from './people_list.js';

/** What is known of the people in the room. */
export interface People {
  room: string;
  own: number;
  viewers: Viewer[];
  policy: State['policy'];
  follows: number;
}

/** Says by whose camera the viewer sees and whether it may hold, and opens the list of people. */
export class PeoplePanel {
  private viewers: Viewer[] = [];
  private policy: State['policy'] = 'everybody';
  private list: PeopleList | null = null;
  private dialog = element<HTMLDialogElement>('name-dialog');

  constructor(
    private client: WeftClient,
    private company: Company,
    private tell: (text: string) => void,
  ) {
    client.on('roster', ({ viewers }) => {
      this.viewers = viewers;
      this.show();
    });
    client.on('state', ({ policy }) => {
      if (policy === this.policy) return;
      this.policy = policy;
      this.show();
    });
    element('viewers').addEventListener('click', ({ target }) => {
      if (target instanceof Element && target.closest('button')) void this.open();
    });
    element('following').addEventListener('click', () => this.company.leave());
    element('take-hand').addEventListener('click', () => tell_refusal(client.giveHand(client.viewer), tell));
  }

  /** Something about the people has changed. */
  show(): void {
    const own = this.viewers.find(({ id }) => id === this.client.viewer);
    const followed = this.viewers.find(({ id }) => id === this.company.follows);
    element('following').hidden = !followed;
    write_words(element('following'), followed ? `You see what ${named(followed.name)} sees. Stop` : '');
    const looks = own?.hand === false;
    element('only-looks').hidden = !looks || own.role !== 'viewer';
    element('take-hand').hidden = !looks || own.role === 'viewer';
    if (this.dialog.open) this.list?.show(this.people());
  }

  private people(): People {
    const { viewers, policy } = this;
    return { room: own_room(), own: this.client.viewer, viewers, policy, follows: this.company.follows };
  }

  /** The list is no part of the first load. */
  private async open(): Promise<void> {
    const { PeopleList, styles } = await import('./people_list.js');
    await styles();
    const attempt = (answer: Promise<unknown>) => tell_refusal(answer, this.tell);
    this.list ??= new PeopleList(element('people'), this.client, { attempt, link_with });
    this.list.show(this.people());
  }
}

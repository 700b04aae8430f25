import type { WeftClient } from '../../../proto/js/index.js';
import type { State, Viewer } from '../../../proto/js/messages.js';
import { late_styles } from './late_styles.js';
import type { People } from './people.js';

const POLICIES: [State['policy'], string][] = [
  ['everybody', 'Everybody holds'],
  ['one_hand', 'One hand each'],
  ['watch', 'Others watch'],
];

/** What the page has already, so that the list stays small. */
interface Tools {
  /** Awaits a command in the background and tells its refusal. */
  attempt(answer: Promise<unknown>): void;
  /** The page's address with another token. */
  link_with(token: string): string;
}

/** The list's own styles, which must have come before it is shown. */
export const styles = () => late_styles('people.css');

/** Who is here, who may hold the cloth, and links that let others in. */
export class PeopleList {
  private policies = make('div', 'policies');
  private exceptions = make('p', 'exceptions');
  private rows = make('ul', 'rows');
  private made = new Map<number, { told: string; row: HTMLElement }>(); // the rows, by their viewers
  private links = make('div', 'links');
  private link = make('div', 'link'); // the one that was made last
  private room = ''; // for which it was made
  private told = '';

  constructor(
    root: HTMLElement,
    private client: WeftClient,
    private tools: Tools,
  ) {
    this.policies.setAttribute('role', 'group');
    this.policies.setAttribute('aria-label', 'Who may hold the cloth');
    this.rows.setAttribute('aria-label', 'People');
    root.replaceChildren(this.policies, this.exceptions, this.rows, this.links);
    this.make_links();
  }

  /** Changes nothing, and no focus, while all is as it was. A link lets others into one room, and goes with it. */
  show(people: People): void {
    if (people.room !== this.room) this.link.replaceChildren();
    this.room = people.room;
    const told = JSON.stringify([people.own, people.policy, people.follows, people.viewers.map(known_of)]);
    if (told === this.told) return;
    this.told = told;
    const focus = document.activeElement instanceof HTMLElement ? document.activeElement.dataset.key : undefined;
    const operates = people.viewers.find(({ id }) => id === people.own)?.role !== 'viewer';
    this.policies.hidden = this.links.hidden = !operates;
    this.policies.replaceChildren(...this.policy_buttons(people), this.lead_button());
    this.tell_exceptions(people, operates);
    const own_first = [...people.viewers].sort((a, b) => Number(b.id === people.own) - Number(a.id === people.own));
    this.made = new Map(own_first.map((one) => [one.id, this.made_row(one, people, operates)]));
    this.rows.replaceChildren(...[...this.made.values()].map(({ row }) => row));
    if (focus) this.rows.parentElement?.querySelector<HTMLElement>(`[data-key="${focus}"]`)?.focus({ preventScroll: true });
  }

  /** A policy that is not so for some is half pressed. */
  private policy_buttons({ policy, viewers }: People): HTMLElement[] {
    const partly = policy !== 'watch' && viewers.some(({ hand }) => !hand);
    return POLICIES.map(([value, words]) => {
      const button = this.button(`policy-${value}`, words, () => this.client.policy(value));
      button.setAttribute('aria-pressed', policy !== value ? 'false' : partly ? 'mixed' : 'true');
      return button;
    });
  }

  /** Newcomers to a crowd wait for a hand whatever the policy, and who was muted has none. */
  private tell_exceptions({ policy, viewers }: People, operates: boolean): void {
    const holding = viewers.filter(({ hand }) => hand).length;
    this.exceptions.hidden = !operates || policy === 'watch' || holding === viewers.length;
    const words = POLICIES.find(([value]) => value === policy)![1];
    this.exceptions.textContent =
      `${holding} of ${viewers.length} may hold. Press “${words}” to let newcomers hold too; ` +
      `who was muted holds again by the box beside the name.`;
  }

  private lead_button(): HTMLElement {
    return this.button('lead', 'Bring all to my view', () => this.client.lead());
  }

  /** A row as it was made last, if nothing of it has changed. */
  private made_row(viewer: Viewer, people: People, operates: boolean): { told: string; row: HTMLElement } {
    const told = JSON.stringify([known_of(viewer), viewer.id === people.own, people.follows === viewer.id, operates]);
    const made = this.made.get(viewer.id);
    return made?.told === told ? made : { told, row: this.row(viewer, people, operates) };
  }

  private row(viewer: Viewer, { own, follows }: People, operates: boolean): HTMLElement {
    const row = make('li', '');
    row.style.setProperty('--color', viewer.color);
    const role = viewer.role === 'viewer' ? '' : ` · ${viewer.role}`;
    const name = make('bdi', 'viewer-name', viewer.name);
    name.title = viewer.name;
    row.append(make('span', 'swatch'), name, make('span', 'role', `${viewer.id === own ? ' (you)' : ''}${role}`));
    if (operates) row.append(this.hand_box(viewer));
    if (viewer.id === own) return row;
    const following = follows === viewer.id;
    const follow = this.button(`follow-${viewer.id}`, 'Follow', () => this.client.follow(following ? 0 : viewer.id));
    follow.setAttribute('aria-pressed', String(following));
    follow.setAttribute('aria-label', `Follow ${viewer.name}`);
    row.append(follow);
    return row;
  }

  /** Gives a viewer a hand, or takes it whatever the policy. */
  private hand_box({ id, name, hand }: Viewer): HTMLElement {
    const label = make('label', 'hand');
    const box = document.createElement('input');
    box.type = 'checkbox';
    box.checked = hand;
    box.dataset.key = `hand-${id}`;
    box.setAttribute('aria-label', `${name} may hold`);
    box.addEventListener('change', () => {
      const answer = box.checked ? this.client.giveHand(id) : this.client.mute(id);
      this.tools.attempt(answer);
      this.told = ''; // made anew, also if the list is closed until it is as before
      this.made.delete(id);
      answer.catch(() => (box.checked = hand)); // if refused, it is as it was
    });
    label.append(box, 'holds');
    return label;
  }

  private make_links(): void {
    const make_link = async (right: 'look' | 'hold') => {
      const { token } = (await this.client.invite(right)) as unknown as { token: string };
      const link = this.tools.link_with(token);
      const { renderSVG } = await import('uqr');
      if (link !== this.tools.link_with(token)) return; // the page is in another room by now
      const field = document.createElement('input');
      field.className = 'field';
      field.readOnly = true;
      field.value = link;
      field.setAttribute('aria-label', `Link to ${right}`);
      const picture = make('div', 'code');
      picture.setAttribute('role', 'img');
      picture.setAttribute('aria-label', `QR code of the link to ${right}`);
      picture.innerHTML = renderSVG(link, { border: 4 });
      this.link.replaceChildren(field, picture);
      field.select();
    };
    this.links.append(
      this.button('link-look', 'Link to look', () => make_link('look')),
      this.button('link-hold', 'Link to hold', () => make_link('hold')),
      this.link,
    );
  }

  private button(key: string, words: string, act: () => Promise<unknown>): HTMLElement {
    const button = document.createElement('button');
    button.type = 'button';
    button.className = 'plain';
    button.dataset.key = key;
    button.textContent = words;
    button.addEventListener('click', () => this.tools.attempt(act()));
    return button;
  }
}

/** What of a viewer the list shows. */
function known_of({ id, name, color, role, hand }: Viewer) {
  return [id, name, color, role, hand];
}

function make(tag: string, name: string, text = ''): HTMLElement {
  const made = document.createElement(tag);
  made.className = name;
  made.textContent = text;
  return made;
}

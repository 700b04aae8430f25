import { Group, Vector3 } from 'three';
import type { PerspectiveCamera } from 'three';
import type { Grab, Vec3, Viewer } from '../../../proto/js/messages.js';
import { MarkDot, MarkLine } from './marks.js';
import { named, write_words } from './words.js';

export const NO_COLOR = '#5c6068'; // of an unknown viewer
const LINE_WIDTH = 2.5; // [pixels]
const LINE_OPACITY = 0.92;
const DOT_RADIUS = 4.5; // [pixels]
const TARGET_RADIUS = 6.5; // [pixels]
const LABEL_OFFSET = 14; // [pixels]
const FINGER_OFFSET = 56; // of a label that a finger must not cover, upwards [pixels]
const STEADY_PART = 0.04; // by which a force changes before it is written anew
const STEADY_FORCE = 0.05; // [N]
const MOST_SPARE = 4; // marks of hands that have let go

/** A hand that holds the cloth, as drawn. */
export interface Hand {
  /** Differs from that of every other drawn hand, and stays. */
  key: string;
  /** Identifies a hand: the room's number, or 0 for the own hand before the server has sent it. */
  id: number;
  name: string;
  color: string;
  held: Vec3;
  target: Vec3;
  /** The own hand needs no name. */
  own: boolean;
  /** Whether a finger covers its target. */
  finger: boolean;
  /** Whether cloth or objects hide its target. */
  hidden: boolean;
  /** With which it pulls [N]; null if that is not known yet. */
  force: number | null;
}

/** The owner of another viewer's hand. */
export function owner_of({ id, viewer }: Grab, who: Viewer | undefined) {
  const name = who?.name ?? (viewer ? `viewer ${viewer}` : 'scene');
  return { id, name, color: who?.color ?? NO_COLOR, own: false, finger: false };
}

/** Lines from held points to their targets, labelled with the hands' owners and forces. */
export class Hands {
  readonly group = new Group();
  private marks = new Map<string, HandMark>();
  /** Kept for the next hand: with the last mark a program would go, and be made anew in the next grasp. */
  private spare: HandMark[] = [];
  shown: Hand[] = [];

  constructor(private labels: HTMLElement) {
    this.spare.push(this.make()); // so that programs are made before the first grasp
  }

  update(hands: Hand[], camera: PerspectiveCamera, width: number, height: number): void {
    this.shown = hands;
    const present = new Set(hands.map(({ key }) => key));
    for (const [name, mark] of this.marks) {
      if (present.has(name)) continue;
      mark.hide();
      this.spare.push(mark);
      this.marks.delete(name);
    }
    for (const hand of hands) {
      const mark = this.marks.get(hand.key) ?? this.spare.pop() ?? this.make();
      this.marks.set(hand.key, mark);
      mark.update(hand, camera, width, height);
    }
    while (this.spare.length > MOST_SPARE) this.spare.pop()?.dispose();
  }

  private make(): HandMark {
    const mark = new HandMark(this.labels);
    this.group.add(mark.group);
    return mark;
  }
}

class HandMark {
  readonly group = new Group();
  private line = new MarkLine(LINE_WIDTH, LINE_OPACITY, 20);
  private held = new MarkDot(DOT_RADIUS, 21);
  private target = new MarkDot(TARGET_RADIUS, 23);
  private label = document.createElement('span');
  private words = ''; // as written
  private force: number | null = null; // the same [N]
  private label_width = 0; // of what is written; 0: not measured yet [pixels]

  constructor(private labels: HTMLElement) {
    for (const mark of this.parts) this.group.add(mark.group);
    this.label.className = 'name';
    this.group.visible = false;
  }

  /** Until the next update; its force is forgotten. */
  hide(): void {
    this.group.visible = false;
    this.label.remove();
    this.force = null;
  }

  update(hand: Hand, camera: PerspectiveCamera, width: number, height: number): void {
    if (!this.group.visible) this.labels.append(this.label);
    this.group.visible = true;
    this.line.set([hand.held, hand.target], width, height);
    this.held.set(hand.held, camera, height);
    this.target.set(hand.target, camera, height);
    for (const part of this.parts) part.color = hand.color;
    this.write(hand);
    this.place_label(hand, camera, width, height);
  }

  /** Beside the target of somebody's hand, beside the line of the own one. */
  private place_label(hand: Hand, camera: PerspectiveCamera, width: number, height: number): void {
    const { label } = this;
    const target = new Vector3(...hand.target);
    const place = hand.own ? target.clone().add(new Vector3(...hand.held)).multiplyScalar(0.5) : target;
    const point = place.project(camera);
    label.hidden = Math.abs(point.z) > 1 || this.words === '';
    if (label.hidden) return;
    this.label_width ||= label.offsetWidth;
    const above = hand.finger ? FINGER_OFFSET : 0;
    const at = { x: ((point.x + 1) / 2) * width, y: ((1 - point.y) / 2) * height - above };
    const x = label_left(at.x, this.label_width, width);
    label.style.transform = `translate(${x.toFixed(1)}px, ${at.y.toFixed(1)}px) translateY(-50%)`;
  }

  dispose(): void {
    this.group.removeFromParent();
    this.label.remove();
    for (const part of this.parts) part.dispose();
  }

  private get parts() {
    return [this.line, this.held, this.target];
  }

  private write({ name, color, own, hidden, force }: Hand): void {
    const { label } = this;
    label.style.setProperty('--color', color);
    label.toggleAttribute('data-own', own);
    label.toggleAttribute('data-hidden', hidden);
    const steady =
      force !== null &&
      this.force !== null &&
      Math.abs(force - this.force) < Math.max(STEADY_FORCE, STEADY_PART * this.force);
    if (!steady) this.force = force;
    const words = [own ? '' : named(name), this.force === null ? '' : force_text(this.force)];
    const text = words.filter(Boolean).join(' · ');
    if (this.words === text) return;
    this.words = text;
    write_words(label, text);
    this.label_width = 0;
  }
}

/** @param force [N] */
function force_text(force: number): string {
  return `${force.toFixed(force < 9.95 ? 1 : 0)} N`;
}

/**
 * Where a label begins: to the right of a mark, or to its left where it would leave the picture. Beside a
 * mark that is itself outside it leaves the picture too.
 * @param mark where that is; all in pixels from the picture's left edge
 */
export function label_left(mark: number, label: number, picture: number): number {
  const right = mark + LABEL_OFFSET;
  const fits = right + label <= picture || mark > picture;
  return fits ? right : Math.max(0, mark - LABEL_OFFSET - label);
}

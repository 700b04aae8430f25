import { Group, Vector3 } from 'three';
import type { PerspectiveCamera } from 'three';
import type { Grab, Vec3, Viewer } from '../../../proto/js/messages.js';
import { Label, Labels } from './labels.js';
import { MarkDot, MarkLine } from './marks.js';
import { named } from './words.js';

export const NO_COLOR = '#5c6068'; // of an unknown viewer
const LINE_WIDTH = 2.5; // [pixels]
const LINE_OPACITY = 0.92;
const DOT_RADIUS = 4.5; // [pixels]
const TARGET_RADIUS = 6.5; // [pixels]
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
  readonly labels: Labels;

  /** @param labels element of all that is written beside marks */
  constructor(labels: HTMLElement) {
    this.labels = new Labels(labels);
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
  private label: Label;
  private force: number | null = null; // as written [N]

  constructor(labels: Labels) {
    this.label = new Label(labels);
    for (const mark of this.parts) this.group.add(mark.group);
    this.group.visible = false;
  }

  /** Until the next update; its force is forgotten. */
  hide(): void {
    this.group.visible = false;
    this.label.remove();
    this.force = null;
  }

  update(hand: Hand, camera: PerspectiveCamera, width: number, height: number): void {
    this.group.visible = true;
    this.line.set([hand.held, hand.target], width, height);
    this.held.set(hand.held, camera, height);
    this.target.set(hand.target, camera, height);
    for (const part of this.parts) part.color = hand.color;
    this.write(hand);
    this.aim_label(hand, camera);
  }

  /** Beside the target of somebody's hand, beside the line of the own one. */
  private aim_label(hand: Hand, camera: PerspectiveCamera): void {
    const point = new Vector3(...hand.target);
    if (hand.own) point.add(new Vector3(...hand.held)).multiplyScalar(0.5);
    this.label.aim(point, camera, hand.finger ? FINGER_OFFSET : 0);
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
    const { element } = this.label;
    element.style.setProperty('--color', color);
    element.toggleAttribute('data-own', own);
    element.toggleAttribute('data-hidden', hidden);
    const steady =
      force !== null &&
      this.force !== null &&
      Math.abs(force - this.force) < Math.max(STEADY_FORCE, STEADY_PART * this.force);
    if (!steady) this.force = force;
    const words = [own ? '' : named(name), this.force === null ? '' : force_text(this.force)];
    this.label.write(words.filter(Boolean).join(' · '));
  }
}

/** @param force [N] */
function force_text(force: number): string {
  return `${force.toFixed(force < 9.95 ? 1 : 0)} N`;
}

import { Group, Vector3 } from 'three';
import type { PerspectiveCamera } from 'three';
import type { Vec3 } from '../../../proto/js/messages.js';
import { Label } from './labels.js';
import type { Labels } from './labels.js';
import { MarkDot } from './marks.js';
import { named } from './words.js';

const RADIUS = 5; // [pixels]
const MOST = 12; // drawn; more hide the cloth
const ORDER = 24; // above the hands

/** What another viewer points at, as drawn. */
export interface DrawnCursor {
  viewer: number;
  name: string;
  color: string;
  place: Vec3;
}

/** Dots with names where others point at the cloth. */
export class Cursors {
  readonly group = new Group();
  shown: DrawnCursor[] = [];
  private marks: { dot: MarkDot; label: Label }[] = [];

  constructor(private labels: Labels) {}

  update(cursors: DrawnCursor[], camera: PerspectiveCamera, height: number): void {
    this.shown = cursors.slice(0, MOST);
    while (this.marks.length > this.shown.length) this.drop();
    while (this.marks.length < this.shown.length) this.add();
    this.shown.forEach(({ name, color, place }, k) => {
      const { dot, label } = this.marks[k];
      dot.color = color;
      dot.set(place, camera, height);
      label.write(named(name));
      label.element.style.setProperty('--color', color);
      label.aim(new Vector3(...place), camera);
    });
  }

  private add(): void {
    const mark = { dot: new MarkDot(RADIUS, ORDER), label: new Label(this.labels) };
    this.group.add(mark.dot.group);
    this.marks.push(mark);
  }

  private drop(): void {
    const mark = this.marks.pop();
    mark?.dot.dispose();
    mark?.label.remove();
  }
}

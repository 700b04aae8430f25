import { Group, Vector3 } from 'three';
import type { PerspectiveCamera } from 'three';
import type { Vec3 } from '../../../proto/js/messages.js';
import { MarkDot } from './marks.js';
import { named, write_words } from './words.js';

const RADIUS = 5; // [pixels]
const MOST = 12; // drawn; more hide the cloth
const LABEL_OFFSET = 12; // [pixels]
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
  private marks: { dot: MarkDot; label: HTMLElement }[] = [];

  constructor(private labels: HTMLElement) {}

  update(cursors: DrawnCursor[], camera: PerspectiveCamera, width: number, height: number): void {
    this.shown = cursors.slice(0, MOST);
    while (this.marks.length > this.shown.length) this.drop();
    while (this.marks.length < this.shown.length) this.add();
    this.shown.forEach(({ name, color, place }, k) => {
      const { dot, label } = this.marks[k];
      dot.color = color;
      dot.set(place, camera, height);
      if (label.textContent !== name) write_words(label, named(name));
      label.style.setProperty('--color', color);
      const point = new Vector3(...place).project(camera);
      label.hidden = Math.abs(point.z) > 1;
      const x = ((point.x + 1) / 2) * width + LABEL_OFFSET;
      const y = ((1 - point.y) / 2) * height;
      label.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translateY(-50%)`;
    });
  }

  private add(): void {
    const mark = { dot: new MarkDot(RADIUS, ORDER), label: document.createElement('span') };
    mark.label.className = 'name';
    this.labels.append(mark.label);
    this.group.add(mark.dot.group);
    this.marks.push(mark);
  }

  private drop(): void {
    const mark = this.marks.pop();
    mark?.dot.dispose();
    mark?.label.remove();
  }
}

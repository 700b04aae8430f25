import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments } from 'three';
import type { MeshAnnouncement, Pin } from '../../../proto/js/messages.js';
import type { marks_of, TextileTest } from './textile_marks.js';

/** Height of the ground [m]; null if there is none. */
function floor_of({ colliders }: MeshAnnouncement): number | null {
  const ground = colliders.find(({ kind }) => kind === 'plane');
  return ground?.kind === 'plane' ? ground.point[1] : null;
}

/** The marks of a textile test in the picture: rulers, outlines and angles of what is measured. */
export class Laboratory {
  readonly lines = new LineSegments(
    new BufferGeometry(),
    new LineBasicMaterial({ color: '#1f6fb4', toneMapped: false }),
  );
  private test: TextileTest | null = null;
  private marks_of: typeof marks_of | null = null; // loaded with the first test

  constructor() {
    this.lines.frustumCulled = false;
    this.lines.visible = false;
  }

  /** Shows the marks of a test, or none. */
  async show(test: TextileTest | null): Promise<void> {
    this.test = test;
    this.lines.visible = false; // until they are drawn
    if (test && !this.marks_of) this.marks_of = (await import('./textile_marks.js')).marks_of;
  }

  /** Draws the marks of the cloth as it is shown now. */
  update(
    announcement: MeshAnnouncement,
    triangles: ArrayLike<number>,
    positions: ArrayLike<number>,
    pins: Pin[],
  ): void {
    const pin = pins.find(({ viewer }) => viewer === 0);
    const floor = floor_of(announcement);
    this.lines.visible = false;
    if (!this.test || !this.marks_of || !pin || floor === null) return;
    this.lines.visible = true;
    const specimen = { positions, triangles, cloth: announcement.cloths[0], pin, floor };
    this.write(this.marks_of(this.test, specimen));
  }

  /** The drawn lines: three numbers per point, two points per line. */
  drawn(): number[] {
    if (!this.lines.visible) return [];
    return [...this.lines.geometry.getAttribute('position').array];
  }

  private write(points: number[]): void {
    const { geometry } = this.lines;
    const known = geometry.getAttribute('position') as BufferAttribute | undefined;
    if (known && known.array.length === points.length) {
      known.array.set(points);
      known.needsUpdate = true;
      return;
    }
    geometry.dispose();
    this.lines.geometry = new BufferGeometry();
    this.lines.geometry.setAttribute('position', new BufferAttribute(new Float32Array(points), 3));
  }
}

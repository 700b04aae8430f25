import { BufferAttribute, BufferGeometry, DynamicDrawUsage, LineBasicMaterial, LineSegments } from 'three';

const FLOATS = 6; // a box: lowest and highest corner
// Corners of the twelve edges, two per edge; bit k of a corner chooses its coordinate k.
const EDGES = [0, 1, 2, 3, 4, 5, 6, 7, 0, 2, 1, 3, 4, 6, 5, 7, 0, 4, 1, 5, 2, 6, 3, 7];

/** Axis-aligned boxes as lines along their edges. */
export class Boxes {
  readonly lines = new LineSegments(
    new BufferGeometry(),
    new LineBasicMaterial({ color: '#1746a2', transparent: true, opacity: 0.75 }),
  );
  private capacity = 0;

  constructor() {
    this.lines.frustumCulled = false;
    this.show([]);
  }

  /** @param values six numbers per box, lowest and highest corner [m] */
  show(values: ArrayLike<number>): void {
    const count = values.length / FLOATS;
    if (count > this.capacity) this.reserve(count);
    const { geometry } = this.lines;
    if (count > 0) {
      const attribute = geometry.getAttribute('position') as BufferAttribute;
      const points = attribute.array;
      let next = 0;
      for (let box = 0; box < values.length; box += FLOATS) {
        for (const corner of EDGES) {
          for (let axis = 0; axis < 3; axis++) {
            points[next++] = values[box + axis + ((corner >> axis) & 1) * 3];
          }
        }
      }
      attribute.needsUpdate = true;
    }
    geometry.setDrawRange(0, count * EDGES.length);
    this.lines.visible = count > 0;
  }

  /** The drawn lines: three numbers per point, two points per line. */
  drawn(): number[] {
    const { geometry, visible } = this.lines;
    if (!visible) return [];
    const { array } = geometry.getAttribute('position');
    return [...array.subarray(0, geometry.drawRange.count * 3)];
  }

  private reserve(count: number): void {
    this.capacity = Math.max(count, 2 * this.capacity);
    this.lines.geometry.dispose();
    this.lines.geometry = new BufferGeometry();
    const points = new BufferAttribute(new Float32Array(this.capacity * EDGES.length * 3), 3);
    this.lines.geometry.setAttribute('position', points.setUsage(DynamicDrawUsage));
  }
}

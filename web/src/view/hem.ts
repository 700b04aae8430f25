import { border_of, reversed } from './border.js';

const CORNERS = 8; // of the section of an edge
const WIDTH = 1.25; // of a section, beside its thickness

/**
 * The thick edge of cloths: a round section along each border, whose outermost points are those of
 * the border itself. Its triangles and normals face inwards, because what is seen of it then is
 * their other side, which has the colour of the cloth's front.
 */
export class Hem {
  /** Of the sections, as `first` + CORNERS * k + corner for the border's k-th vertex. */
  readonly triangles: Uint32Array;
  /** Vertices of the cloths at their borders, each with the one before and the one after it. */
  private borders: Uint32Array;

  /**
   * @param triangles of the cloths
   * @param first     index of the first vertex of a section
   */
  constructor(triangles: Uint32Array, readonly first: number) {
    const next = border_of(triangles);
    const before = reversed(next);
    const inside = [...next].filter(([a]) => before.has(a));
    this.borders = Uint32Array.from(inside.flatMap(([a, b]) => [a, before.get(a)!, b]));
    const place = new Map(inside.map(([a], k) => [a, k]));
    this.triangles = Uint32Array.from(
      inside.flatMap(([, b], k) => {
        const other = place.get(b);
        return other === undefined ? [] : this.band(k, other);
      }),
    );
  }

  /** How many vertices the sections have. */
  get vertices(): number {
    return (this.borders.length / 3) * CORNERS;
  }

  /** The cloth's vertex that a section belongs to. */
  vertex(section: number): number {
    return this.borders[section * 3];
  }

  /** Copies values of the cloths' vertices to those of the sections. */
  copy(values: Float32Array, components: number): void {
    let to = this.first * components;
    for (let k = 0; k < this.borders.length; k += 3) {
      const from = this.borders[k] * components;
      for (let corner = 0; corner < CORNERS; corner++) {
        for (let part = 0; part < components; part++, to++) values[to] = values[from + part];
      }
    }
  }

  /**
   * Places the sections.
   * @param thickness half of it, for each vertex of the cloths [m]
   */
  place(positions: Float32Array, normals: Float32Array, thickness: Float32Array): void {
    let to = this.first * 3;
    for (let k = 0; k < this.borders.length; k += 3) {
      const at = this.borders[k];
      const p = at * 3;
      const before = this.borders[k + 1] * 3;
      const after = this.borders[k + 2] * 3;
      const tx = positions[after] - positions[before];
      const ty = positions[after + 1] - positions[before + 1];
      const tz = positions[after + 2] - positions[before + 2];
      const nx = normals[p];
      const ny = normals[p + 1];
      const nz = normals[p + 2];
      // Out of the cloth, whose triangles lie to the left of its border.
      let ox = ty * nz - tz * ny;
      let oy = tz * nx - tx * nz;
      let oz = tx * ny - ty * nx;
      const inverse = 1 / (Math.sqrt(ox * ox + oy * oy + oz * oz) || 1);
      ox *= inverse;
      oy *= inverse;
      oz *= inverse;
      const high = thickness[at];
      const wide = high * WIDTH;
      for (let corner = 0; corner < CORNERS; corner++, to += 3) {
        const up = UP[corner];
        const out = OUT[corner];
        const along = wide * (out - 1);
        positions[to] = positions[p] + along * ox + high * up * nx;
        positions[to + 1] = positions[p + 1] + along * oy + high * up * ny;
        positions[to + 2] = positions[p + 2] + along * oz + high * up * nz;
        normals[to] = -out * ox - up * nx;
        normals[to + 1] = -out * oy - up * ny;
        normals[to + 2] = -out * oz - up * nz;
      }
    }
  }

  private band(section: number, next: number): number[] {
    return Array.from({ length: CORNERS }, (_, corner) => {
      const after = (corner + 1) % CORNERS;
      const [a, b] = [section, next].map((each) => this.first + each * CORNERS + corner);
      const [c, d] = [section, next].map((each) => this.first + each * CORNERS + after);
      return [a, c, b, b, c, d];
    }).flat();
  }
}

const ANGLES = Array.from({ length: CORNERS }, (_, k) => (k / CORNERS) * 2 * Math.PI);
const UP = Float64Array.from(ANGLES, Math.sin);
const OUT = Float64Array.from(ANGLES, Math.cos);

const MOST_SHIFT = 0.3; // of the distance between rows

/** A cloth that is a grid: its first vertex, and how many rows and columns of vertices it has. */
export interface Grid {
  first_vertex: number;
  rows: number;
  columns: number;
}

/**
 * Draws stripes along the rows of a grid as smooth curves. Between particles the finer mesh leaves the
 * simulated one at right angles alone, so that a row that bends within the cloth is a line with corners. Here
 * the pattern is shifted across rows instead, to where a cubic through four particles (Catmull and Rom
 * 1974) has them. Vertices stay where they are; so do the outermost rows, which are the border.
 */
export class StripeCurves {
  private heights: Float32Array; // along v, without a shift [m]
  private rows: Float32Array; // of each vertex, with a fraction
  private slots: Uint32Array; // of each vertex, along its rows
  private shifts: Float32Array; // of each row, by slot [rows]
  private width: number; // of a row [slots]
  private row_height: number; // [m]

  /**
   * @param vertices new ones of the finer mesh, in this grid
   * @param uv       two values per vertex [m]
   * @param size     of the cloth along u and v [m]
   * @param parts    in which the finer mesh divides an edge
   */
  constructor(
    private grid: Grid,
    private vertices: Uint32Array,
    uv: Float32Array,
    size: [number, number],
    private parts: number,
  ) {
    this.width = (grid.columns - 1) * parts + 1;
    this.row_height = size[1] / (grid.rows - 1);
    this.heights = Float32Array.from(vertices, (vertex) => uv[vertex * 2 + 1]);
    this.rows = this.heights.map((height) => height / this.row_height);
    const slot = size[0] / (this.width - 1);
    this.slots = Uint32Array.from(vertices, (vertex) => Math.round(uv[vertex * 2] / slot));
    this.shifts = new Float32Array(grid.rows * this.width);
  }

  /**
   * Writes where the vertices are in the pattern.
   * @param positions three values per vertex, of the simulated ones at least [m]
   * @param uv        out; two values per vertex [m]
   */
  place(positions: Float32Array, uv: Float32Array): void {
    const { rows, columns } = this.grid;
    for (let row = 1; row < rows - 1; row++) {
      for (let column = 0; column < columns - 1; column++) this.shift_cell(row, column, positions);
    }
    const { vertices, heights, slots, shifts, width, row_height } = this;
    for (let k = 0; k < vertices.length; k++) {
      const row = Math.min(rows - 2, Math.floor(this.rows[k]));
      const part = this.rows[k] - row;
      const at = row * width + slots[k];
      const shift = shifts[at] * (1 - part) + shifts[at + width] * part;
      uv[vertices[k] * 2 + 1] = heights[k] + shift * row_height;
    }
  }

  /** Writes where they are without a shift. */
  straighten(uv: Float32Array): void {
    for (const [k, vertex] of this.vertices.entries()) uv[vertex * 2 + 1] = this.heights[k];
  }

  /** The shifts between two particles of a row. */
  private shift_cell(row: number, column: number, positions: Float32Array): void {
    const { first_vertex, columns } = this.grid;
    const at = (first_vertex + row * columns + column) * 3;
    const pitch = columns * 3;
    // Beyond the ends of a row it goes straight on.
    const before = column > 0 ? at - 3 : -1;
    const after = column + 2 < columns ? at + 6 : -1;
    for (let part = 1; part < this.parts; part++) {
      const f = part / this.parts;
      const first = f * (-0.5 + f * (1 - 0.5 * f));
      const last = f * f * (0.5 * f - 0.5);
      let along_along = 0;
      let along_across = 0;
      let across_across = 0;
      let bow_along = 0;
      let bow_across = 0;
      for (let axis = 0; axis < 3; axis++) {
        const a = positions[at + axis];
        const b = positions[at + 3 + axis];
        const p = before < 0 ? 2 * a - b : positions[before + axis];
        const q = after < 0 ? 2 * b - a : positions[after + axis];
        // The cubic beside the straight line: its weights for a and b follow from those for p and q.
        const bow = first * (p - 2 * a + b) + last * (a - 2 * b + q);
        const along = b - a;
        const across = (1 - f) * (positions[at + pitch + axis] - positions[at - pitch + axis]) / 2 +
          f * (positions[at + 3 + pitch + axis] - positions[at + 3 - pitch + axis]) / 2;
        along_along += along * along;
        along_across += along * across;
        across_across += across * across;
        bow_along += bow * along;
        bow_across += bow * across;
      }
      // Of the bow, what lies in the cloth and across the row.
      const slant = along_across / (along_along || 1);
      const square = across_across - slant * along_across;
      const shift = -(bow_across - slant * bow_along) / (square || 1);
      const slot = row * this.width + column * this.parts + part;
      this.shifts[slot] = Math.min(MOST_SHIFT, Math.max(-MOST_SHIFT, shift));
    }
  }
}

import { border_of, reversed } from './border.js';

/** New vertices of one subdivision: each halves an edge of the one before. */
interface Level {
  /** Two vertices per edge. */
  edges: Uint32Array;
  /** Of edges that are diagonals of cells, the ends of the other diagonal; elsewhere their own. */
  others: Uint32Array;
  /** Three numbers for an edge at a border: its place, and the border's vertices before and after
   *  it, or its own ends where the border ends or has a corner. */
  borders: Uint32Array;
  /** Index of the first new vertex. */
  first: number;
}

const FIRST_SHARE = 0.8; // of the reach, for the first level; a second one takes the rest
const FLAT = 1e-6; // of the bend of a diagonal (`part_of_other`)
// Of how far the normals around a vertex agree (`even_normals`), 0 to 1.
const ROUND = 0.9;
const SHARP = 0.72;

/**
 * The part of its reach that a surface is bent at a vertex: all where it is round, nothing where it is
 * folded sharply, because there its own two layers are nearer to each other than contact keeps others.
 * @param agreement of the normals around it
 */
export function roundness(agreement: number): number {
  return Math.min(1, Math.max(0, (agreement - SHARP) / (ROUND - SHARP)));
}

/**
 * A finer mesh that goes through the vertices of a coarse one, for display. Each edge is bent to a
 * cubic that is perpendicular to the normals at its ends (curved PN triangles, Vlachos et al. 2001),
 * and halved; in the middle of a cell the curves of both diagonals are averaged, and borders are
 * cubics through four of their vertices (the four-point scheme, Dubuc 1986). New vertices stay
 * within `reach` of the coarse triangles, so that surfaces that do not touch are not drawn through
 * each other: less than half of the distance that contact keeps, at sharp folds less (`roundness`), and
 * where that is too little for a smooth outline, less than half of what is free at that moment.
 */
export class Subdivision {
  /** Of the finest level; triangle t of the coarse mesh is 4^levels of these, beginning there. */
  readonly triangles: Uint32Array;
  readonly vertices: number;
  private divisions: Level[] = [];

  /**
   * @param cells   as of `cells_of`
   * @param corners of borders
   * @param levels how often each triangle is divided in four
   */
  constructor(
    vertices: number,
    triangles: Uint32Array,
    cells: Uint32Array,
    corners: Set<number>,
    levels: number,
  ) {
    this.vertices = vertices;
    this.triangles = triangles;
    for (let level = 0; level < levels; level++) {
      const divided = divide(this.triangles, cells, this.vertices);
      const borders = borders_of(this.triangles, corners, divided.number, this.vertices);
      this.divisions.push({ ...divided, borders, first: this.vertices });
      ({ triangles: this.triangles, cells } = divided);
      this.vertices += divided.edges.length / 2;
    }
  }

  /** How often the triangles are divided. */
  get levels(): number {
    return this.divisions.length;
  }

  /** Fills in values of the new vertices, halfway between those of their edges. */
  interpolate(values: Float32Array, components: number): void {
    for (const { edges, first } of this.divisions) {
      for (let e = 0; e < edges.length; e += 2) {
        const to = (first + e / 2) * components;
        for (let k = 0; k < components; k++) {
          const sum = values[edges[e] * components + k] + values[edges[e + 1] * components + k];
          values[to + k] = sum / 2;
        }
      }
    }
  }

  /**
   * Fills in positions and normals of the new vertices.
   * @param positions three values per vertex [m]; those of the coarse mesh are given
   * @param normals   likewise, of unit length
   * @param reach     of each vertex of the coarse mesh: how far the surface may leave its triangles [m];
   *                  that of an edge is the less of its ends'. Is overwritten.
   * @param more      another reach for an edge of the coarse mesh [m], asked where its curve would go
   *                  farther, with the way that the middle would go; the larger of both holds
   */
  refine(
    positions: Float32Array,
    normals: Float32Array,
    reach: Float32Array,
    more: More = () => 0,
  ): void {
    for (const [k, level] of this.divisions.entries()) {
      const share = k > 0 ? (1 - FIRST_SHARE) / (this.levels - 1)
        : this.levels > 1 ? FIRST_SHARE : 1;
      const limit = { reach, share, more: k > 0 ? () => 0 : more };
      halve_edges(level, positions, normals, limit);
      round_borders(level, positions, limit);
      if (k === 0) reach.fill(Infinity, 0, level.first); // of finer edges, by the other end alone
    }
  }
}

type More = (from: number, to: number, way: ArrayLike<number>) => number;

/** How far the new vertices of a level may be moved: as `refine` has it, by a share of the reach. */
interface Limit {
  reach: Float32Array;
  share: number;
  more: More;
}

/** The part of the way `offset` that the vertex which halves an edge may be moved along. */
function part_allowed(limit: Limit, from: number, to: number, vertex: number): number {
  const { reach, share, more } = limit;
  const length = Math.sqrt(offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2]);
  let most = Math.min(reach[from], reach[to]);
  if (length > share * most) most = Math.max(most, more(from, to, offset));
  reach[vertex] = most;
  return length > share * most ? (share * most) / length : 1;
}

function halve_edges(
  { edges, others, first }: Level,
  positions: Float32Array,
  normals: Float32Array,
  limit: Limit,
): void {
  let to = first * 3;
  for (let e = 0; e < edges.length; e += 2, to += 3) {
    const a = edges[e];
    const b = edges[e + 1];
    halve(positions, normals, a, b, middle);
    if (others[e] !== a) {
      halve(positions, normals, others[e], others[e + 1], other_middle);
      const part = part_of_other(middle, other_middle);
      for (let k = 0; k < 6; k++) middle[k] += part * (other_middle[k] - middle[k]);
    }
    const mx = (positions[a * 3] + positions[b * 3]) / 2;
    const my = (positions[a * 3 + 1] + positions[b * 3 + 1]) / 2;
    const mz = (positions[a * 3 + 2] + positions[b * 3 + 2]) / 2;
    offset[0] = middle[0] - mx;
    offset[1] = middle[1] - my;
    offset[2] = middle[2] - mz;
    const part = part_allowed(limit, a, b, first + e / 2);
    positions[to] = mx + part * offset[0];
    positions[to + 1] = my + part * offset[1];
    positions[to + 2] = mz + part * offset[2];
    const nx = middle[3];
    const ny = middle[4];
    const nz = middle[5];
    const norm = Math.sqrt(nx * nx + ny * ny + nz * nz);
    const inverse = norm > 1e-6 ? 1 / norm : 0;
    normals[to] = inverse ? nx * inverse : normals[a * 3];
    normals[to + 1] = inverse ? ny * inverse : normals[a * 3 + 1];
    normals[to + 2] = inverse ? nz * inverse : normals[a * 3 + 2];
  }
}

/**
 * The weight of the other diagonal's curve: half where both bend alike, nearly all where a fold runs
 * along it. Each bends by what the sum of its ends' normals lacks of twice their length.
 */
function part_of_other(own: Float64Array, other: Float64Array): number {
  const bend = (curve: Float64Array) => FLAT + 4 - curve[3] ** 2 - curve[4] ** 2 - curve[5] ** 2;
  const [one, two] = [bend(own), bend(other)];
  return one / (one + two);
}

/** Moves the new vertices of borders onto smooth curves, in the plane of the cloth too. */
function round_borders(
  { edges, borders, first }: Level,
  positions: Float32Array,
  limit: Limit,
): void {
  for (let k = 0; k < borders.length; k += 3) {
    const from = edges[borders[k] * 2];
    const to = edges[borders[k] * 2 + 1];
    for (let axis = 0; axis < 3; axis++) {
      const a = positions[from * 3 + axis];
      const b = positions[to * 3 + axis];
      const before = borders[k + 1] === from ? 2 * a - b : positions[borders[k + 1] * 3 + axis];
      const after = borders[k + 2] === to ? 2 * b - a : positions[borders[k + 2] * 3 + axis];
      offset[axis] = (a + b - before - after) / 16;
    }
    const part = part_allowed(limit, from, to, first + borders[k]);
    const at = (first + borders[k]) * 3;
    for (let axis = 0; axis < 3; axis++) {
      const half = (positions[from * 3 + axis] + positions[to * 3 + axis]) / 2;
      positions[at + axis] = half + part * offset[axis];
    }
  }
}

const offset = new Float64Array(3);
const middle = new Float64Array(6);
const other_middle = new Float64Array(6);

/** Middle of the curve between two vertices, and a normal there of any length. */
function halve(
  positions: Float32Array,
  normals: Float32Array,
  from: number,
  to: number,
  out: Float64Array,
): void {
  const a = from * 3;
  const b = to * 3;
  const dx = positions[b] - positions[a];
  const dy = positions[b + 1] - positions[a + 1];
  const dz = positions[b + 2] - positions[a + 2];
  const ax = normals[a];
  const ay = normals[a + 1];
  const az = normals[a + 2];
  const bx = normals[b];
  const by = normals[b + 1];
  const bz = normals[b + 2];
  const along_a = (dx * ax + dy * ay + dz * az) / 8;
  const along_b = (dx * bx + dy * by + dz * bz) / 8;
  out[0] = positions[a] + dx / 2 + along_b * bx - along_a * ax;
  out[1] = positions[a + 1] + dy / 2 + along_b * by - along_a * ay;
  out[2] = positions[a + 2] + dz / 2 + along_b * bz - along_a * az;
  out[3] = ax + bx;
  out[4] = ay + by;
  out[5] = az + bz;
}

/** Divides each triangle in four; the k-th edge gets the vertex `vertices` + k. */
function divide(triangles: Uint32Array, cells: Uint32Array, vertices: number) {
  const numbers = new Map<number, number>();
  const edges: number[] = [];
  const middle = (a: number, b: number) => {
    const key = a < b ? a * vertices + b : b * vertices + a;
    let number = numbers.get(key);
    if (number === undefined) {
      number = vertices + edges.length / 2;
      numbers.set(key, number);
      edges.push(a, b);
    }
    return number;
  };
  const divided = new Uint32Array(triangles.length * 4);
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = triangles.subarray(t, t + 3);
    const [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
    divided.set([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], t * 4);
  }
  const others = Uint32Array.from(edges);
  const smaller = new Uint32Array(cells.length * 4);
  for (let k = 0; k < cells.length; k += 4) {
    const [a, b, c, d] = cells.subarray(k, k + 4);
    const [ac, cb, bd, da, ab] = [middle(a, c), middle(c, b), middle(b, d), middle(d, a), middle(a, b)];
    others.set([c, d], (ab - vertices) * 2);
    smaller.set([a, ab, ac, da, b, ab, bd, cb, ac, cb, c, ab, bd, da, d, ab], k * 4);
  }
  return { edges: Uint32Array.from(edges), others, triangles: divided, cells: smaller, number: middle };
}

/** The borders of a level. @param number tells the new vertex of an edge */
function borders_of(
  triangles: Uint32Array,
  corners: Set<number>,
  number: (a: number, b: number) => number,
  vertices: number,
): Uint32Array {
  const next = border_of(triangles);
  const before = reversed(next);
  const around = (from: number, way: Map<number, number>) =>
    corners.has(from) ? from : (way.get(from) ?? from);
  return Uint32Array.from(
    [...next].flatMap(([a, b]) => [number(a, b) - vertices, around(a, before), around(b, next)]),
  );
}

const LEAST_CELLS = 16;
const OF_A_KIND = 3; // the longest edge of a mesh that is searched, in mean edges
const STRETCH = 1.5; // the longest edge that is looked for, in lengths at rest
const FAR = 0.6; // no distance beyond this is of interest, in mean edges
const NEAR = 0.1; // of `FAR`: what is nearer might as well touch
const LOOKS = 100; // at triangles in a moment, for each there is: crumpled cloth must not cost a picture

/**
 * Tells how far the nearest other layer of cloth is from an edge, if it is near. Triangles are sorted by
 * their centers into the cells of a grid, kept as a hash; this happens when the first edge of a moment
 * asks.
 */
export class FreeSpace {
  private readonly even: boolean;
  private readonly far: number; // [m]
  private readonly cell: number; // side [m]
  private readonly mask: number;
  private readonly first: Int32Array; // triangle of each cell
  private readonly next: Int32Array; // triangle in the same cell
  private readonly centers: Float32Array; // of triangles [m]
  private readonly radii: Float32Array; // of them, to the farthest corner [m]
  private looks = 0; // left in this moment
  private sorted = false;

  /**
   * @param positions three values per vertex [m]; they change from moment to moment
   * @param rest      the same at rest
   */
  constructor(private positions: Float32Array, rest: Float32Array, private triangles: Uint32Array) {
    let sum = 0;
    let longest = 0;
    for (let t = 0; t < triangles.length; t++) {
      const [a, b] = [triangles[t] * 3, triangles[t % 3 === 2 ? t - 2 : t + 1] * 3];
      const length = Math.hypot(rest[b] - rest[a], rest[b + 1] - rest[a + 1], rest[b + 2] - rest[a + 2]);
      sum += length;
      longest = Math.max(longest, length);
    }
    const mean = sum / (triangles.length || 1);
    this.even = longest <= OF_A_KIND * mean;
    this.far = FAR * mean;
    this.cell = this.far + (2 / 3) * longest * STRETCH; // a center is that far from its corners
    const cells = 2 ** Math.ceil(Math.log2(Math.max(LEAST_CELLS, triangles.length / 3)));
    this.mask = cells - 1;
    this.first = new Int32Array(cells);
    this.next = new Int32Array(triangles.length / 3);
    this.centers = new Float32Array(triangles.length);
    this.radii = new Float32Array(triangles.length / 3);
  }

  /** Begins a moment: the positions have changed. */
  begin(): void {
    this.sorted = false;
    this.looks = LOOKS * this.next.length;
  }

  /**
   * Distance from the middle of an edge to the nearest triangle that it is no side of [m].
   * @returns at most `FAR`; 0 if the mesh is too uneven to be searched, or this moment has had its looks
   */
  around(from: number, to: number): number {
    if (!this.even) return 0;
    if (!this.sorted) this.sort();
    const { positions, triangles, first, next, centers, radii, cell } = this;
    const px = (positions[from * 3] + positions[to * 3]) / 2;
    const py = (positions[from * 3 + 1] + positions[to * 3 + 1]) / 2;
    const pz = (positions[from * 3 + 2] + positions[to * 3 + 2]) / 2;
    const [x, y, z] = [Math.floor(px / cell), Math.floor(py / cell), Math.floor(pz / cell)];
    let nearest = this.far;
    for (let k = 0; k < 27; k++) {
      const place = this.hash(x - 1 + (k % 3), y - 1 + (Math.trunc(k / 3) % 3), z - 1 + Math.trunc(k / 9));
      for (let t = first[place]; t >= 0; t = next[t]) {
        if (--this.looks < 0) return 0;
        const [dx, dy, dz] = [centers[t * 3] - px, centers[t * 3 + 1] - py, centers[t * 3 + 2] - pz];
        if (dx * dx + dy * dy + dz * dz > (nearest + radii[t]) ** 2) continue;
        const [a, b, c] = [triangles[t * 3], triangles[t * 3 + 1], triangles[t * 3 + 2]];
        if ((a === from || b === from || c === from) && (a === to || b === to || c === to)) continue;
        nearest = Math.min(nearest, distance(px, py, pz, positions, a * 3, b * 3, c * 3));
        if (nearest < NEAR * this.far) return 0;
      }
    }
    return nearest;
  }

  private sort(): void {
    const { triangles, positions, first, next, centers, radii, cell } = this;
    first.fill(-1);
    for (let t = 0; t < next.length; t++) {
      const [a, b, c] = [triangles[t * 3] * 3, triangles[t * 3 + 1] * 3, triangles[t * 3 + 2] * 3];
      let radius = 0;
      for (let axis = 0; axis < 3; axis++) {
        centers[t * 3 + axis] = (positions[a + axis] + positions[b + axis] + positions[c + axis]) / 3;
      }
      for (const corner of [a, b, c]) radius = Math.max(radius, squared(centers, t * 3, positions, corner));
      radii[t] = Math.sqrt(radius);
      const place = this.hash(
        Math.floor(centers[t * 3] / cell),
        Math.floor(centers[t * 3 + 1] / cell),
        Math.floor(centers[t * 3 + 2] / cell),
      );
      next[t] = first[place];
      first[place] = t;
    }
    this.sorted = true;
  }

  private hash(x: number, y: number, z: number): number {
    return (Math.imul(x, 73856093) ^ Math.imul(y, 19349663) ^ Math.imul(z, 83492791)) & this.mask;
  }
}

/** Squared distance of two points, which begin there in their arrays [m²]. */
function squared(a: Float32Array, at: number, b: Float32Array, there: number): number {
  return (a[at] - b[there]) ** 2 + (a[at + 1] - b[there + 1]) ** 2 + (a[at + 2] - b[there + 2]) ** 2;
}

/**
 * Distance from a point to a triangle [m]: to its plane if the point is above it, and
 * to the nearest of its sides elsewhere.
 * @param a, b, c where its corners begin in `positions`
 */
function distance(
  px: number, py: number, pz: number, positions: Float32Array, a: number, b: number, c: number,
): number {
  const [sx, sy, sz] = [px - positions[a], py - positions[a + 1], pz - positions[a + 2]];
  const ux = positions[b] - positions[a];
  const uy = positions[b + 1] - positions[a + 1];
  const uz = positions[b + 2] - positions[a + 2];
  const vx = positions[c] - positions[a];
  const vy = positions[c + 1] - positions[a + 1];
  const vz = positions[c + 2] - positions[a + 2];
  const [uu, uv, vv] = [ux * ux + uy * uy + uz * uz, ux * vx + uy * vy + uz * vz, vx * vx + vy * vy + vz * vz];
  const [us, vs] = [ux * sx + uy * sy + uz * sz, vx * sx + vy * sy + vz * sz];
  const area = uu * vv - uv * uv;
  const p = (vv * us - uv * vs) / area;
  const q = (uu * vs - uv * us) / area;
  if (!(p >= 0 && q >= 0 && p + q <= 1)) {
    // Beside it, or it has no area: the nearest of its sides.
    const on_u = Math.min(1, Math.max(0, us / (uu || 1)));
    const on_v = Math.min(1, Math.max(0, vs / (vv || 1)));
    const on_w = Math.min(1, Math.max(0, (vs - uv - us + uu) / (uu - 2 * uv + vv || 1)));
    const square = (r: number, s: number) =>
      (sx - r * ux - s * vx) ** 2 + (sy - r * uy - s * vy) ** 2 + (sz - r * uz - s * vz) ** 2;
    return Math.sqrt(Math.min(square(on_u, 0), square(0, on_v), square(1 - on_w, on_w)));
  }
  const [dx, dy, dz] = [sx - p * ux - q * vx, sy - p * uy - q * vy, sz - p * uz - q * vz];
  return Math.sqrt(dx * dx + dy * dy + dz * dz);
}

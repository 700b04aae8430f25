import { Triangle, Vector3 } from 'three';

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
  private middle = new Vector3();
  private triangle = new Triangle();
  private point = new Vector3();

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
    const { positions, triangles, first, next, centers, radii, cell, middle } = this;
    middle.fromArray(positions, from * 3).add(this.point.fromArray(positions, to * 3)).divideScalar(2);
    const [x, y, z] = [middle.x, middle.y, middle.z].map((place) => Math.floor(place / cell));
    let nearest = this.far;
    for (let k = 0; k < 27; k++) {
      const place = this.hash(x - 1 + (k % 3), y - 1 + (Math.trunc(k / 3) % 3), z - 1 + Math.trunc(k / 9));
      for (let t = first[place]; t >= 0; t = next[t]) {
        if (--this.looks < 0) return 0;
        this.point.fromArray(centers, t * 3);
        if (this.point.distanceToSquared(middle) > (nearest + radii[t]) ** 2) continue;
        const [a, b, c] = [triangles[t * 3], triangles[t * 3 + 1], triangles[t * 3 + 2]];
        if ((a === from || b === from || c === from) && (a === to || b === to || c === to)) continue;
        this.load(t).closestPointToPoint(middle, this.point);
        const found = this.point.distanceTo(middle);
        if (found < nearest) nearest = found; // not if it has no area and no distance
        if (nearest < NEAR * this.far) return 0;
      }
    }
    return nearest;
  }

  private sort(): void {
    const { first, next, centers, radii, cell } = this;
    first.fill(-1);
    for (let t = 0; t < next.length; t++) {
      const { a, b, c } = this.load(t);
      const center = this.triangle.getMidpoint(this.point);
      center.toArray(centers, t * 3);
      radii[t] = Math.max(center.distanceTo(a), center.distanceTo(b), center.distanceTo(c));
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

  private load(t: number): Triangle {
    const { positions, triangles, triangle } = this;
    triangle.a.fromArray(positions, triangles[t * 3] * 3);
    triangle.b.fromArray(positions, triangles[t * 3 + 1] * 3);
    triangle.c.fromArray(positions, triangles[t * 3 + 2] * 3);
    return triangle;
  }

  private hash(x: number, y: number, z: number): number {
    return (Math.imul(x, 73856093) ^ Math.imul(y, 19349663) ^ Math.imul(z, 83492791)) & this.mask;
  }
}

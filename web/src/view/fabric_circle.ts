import type { Vec3 } from '../../../proto/js/messages.js';
import { point_on_triangle } from './ray.js';

const DIRECTIONS = 72;
const MOST_TRIANGLES = 4000; // crossed in one direction
const NONE = 0xffffffff;

/** A point of the cloth, by the weights of a triangle's corners. */
export interface ClothPoint {
  triangle: number;
  barycentric: Vec3;
}

interface Point {
  x: number;
  y: number;
}

/** Corners of a triangle that is laid flat [m], in its order. */
type Flat = [Point, Point, Point];

/**
 * Circles in the fabric: all points at one distance from a point, measured along the flat cloth, as
 * the server measures the disc that a hand holds. Where the cloth ends, they follow its edge.
 */
export class FabricCircle {
  private neighbors: Uint32Array; // across the edge opposite to each corner

  /**
   * @param rest      three values per vertex, of cloth that is not stretched [m]
   * @param triangles three vertices per triangle
   */
  constructor(
    private rest: Float32Array,
    private triangles: Uint32Array,
  ) {
    this.neighbors = neighbors_of(triangles);
  }

  /**
   * A closed line on the cloth.
   * @param radius    in the fabric [m]
   * @param positions of the vertices now [m]
   */
  around({ triangle, barycentric }: ClothPoint, radius: number, positions: Float32Array): Vec3[] {
    const flat = this.lay_flat(triangle);
    const from = at(barycentric, flat);
    const circle = Array.from({ length: DIRECTIONS }, (_, n) => {
      const angle = (2 * Math.PI * n) / DIRECTIONS;
      const to = { x: from.x + radius * Math.cos(angle), y: from.y + radius * Math.sin(angle) };
      const end = this.walk(triangle, flat, from, to);
      return point_on_triangle(end.triangle, end.barycentric, positions, this.triangles);
    });
    return [...circle, circle[0]];
  }

  /** Goes straight on over one triangle after the other, to a point or to the edge of the cloth. */
  private walk(triangle: number, flat: Flat, from: Point, to: Point): ClothPoint {
    for (let crossed = 0; ; crossed++) {
      const start = weights(from, flat);
      const goal = weights(to, flat);
      const leaves = [0, 1, 2].filter((k) => goal[k] < 0 && goal[k] < start[k]);
      const parts = leaves.map((k) => Math.max(0, start[k] / (start[k] - goal[k])));
      const part = Math.min(1, ...parts);
      const edge = triangle * 3 + leaves[parts.indexOf(part)];
      const next = leaves.length ? this.neighbors[edge] : NONE;
      if (next === NONE || crossed === MOST_TRIANGLES) {
        const barycentric = start.map((w, k) => Math.max(0, w + part * (goal[k] - w))) as Vec3;
        return { triangle, barycentric };
      }
      flat = this.unfold(triangle, flat, edge % 3, next);
      triangle = next;
    }
  }

  private lay_flat(triangle: number): Flat {
    const [a, b] = this.triangles.subarray(triangle * 3, triangle * 3 + 2);
    const origin = { x: 0, y: 0 };
    const second = { x: this.length(a, b), y: 0 };
    return [origin, second, this.beyond(second, origin, [b, a, this.triangles[triangle * 3 + 2]])];
  }

  /** Lays a neighbour flat beside a triangle, across the edge opposite to one of its corners. */
  private unfold(triangle: number, flat: Flat, corner: number, next: number): Flat {
    const [i, j] = [(corner + 1) % 3, (corner + 2) % 3];
    const a = this.triangles[triangle * 3 + i];
    const b = this.triangles[triangle * 3 + j];
    return [0, 1, 2].map((k) => {
      const vertex = this.triangles[next * 3 + k];
      if (vertex === a) return flat[i];
      return vertex === b ? flat[j] : this.beyond(flat[i], flat[j], [a, b, vertex]);
    }) as Flat;
  }

  /** The place of the last of three vertices, to the right of the way from the first to the second. */
  private beyond(a: Point, b: Point, vertices: [number, number, number]): Point {
    const side = this.length(vertices[0], vertices[1]);
    const from_a = this.length(vertices[0], vertices[2]);
    const from_b = this.length(vertices[1], vertices[2]);
    const along = (from_a * from_a - from_b * from_b + side * side) / (2 * side);
    const across = Math.sqrt(Math.max(0, from_a * from_a - along * along));
    const [ux, uy] = [(b.x - a.x) / side, (b.y - a.y) / side];
    return { x: a.x + ux * along + uy * across, y: a.y + uy * along - ux * across };
  }

  private length(a: number, b: number): number {
    const { rest } = this;
    const part = (axis: number) => rest[a * 3 + axis] - rest[b * 3 + axis];
    return Math.hypot(part(0), part(1), part(2));
  }
}

function at(barycentric: Vec3, flat: Flat): Point {
  const sum = (axis: 'x' | 'y') =>
    barycentric.reduce((total, weight, k) => total + weight * flat[k][axis], 0);
  return { x: sum('x'), y: sum('y') };
}

/** Weights of a triangle's corners for a point of its plane; negative beyond an edge. */
function weights({ x, y }: Point, [a, b, c]: Flat): Vec3 {
  const area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  const v = ((x - a.x) * (c.y - a.y) - (c.x - a.x) * (y - a.y)) / area;
  const w = ((b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y)) / area;
  return [1 - v - w, v, w];
}

/** For each corner the triangle across the opposite edge, or NONE. */
function neighbors_of(triangles: Uint32Array): Uint32Array {
  const neighbors = new Uint32Array(triangles.length).fill(NONE);
  const open = new Map<number, number>(); // corner by its opposite edge
  for (let corner = 0; corner < triangles.length; corner++) {
    const first = corner - (corner % 3);
    const a = triangles[first + ((corner + 1) % 3)];
    const b = triangles[first + ((corner + 2) % 3)];
    const edge = Math.min(a, b) * 2 ** 26 + Math.max(a, b); // vertices are fewer than that
    const other = open.get(edge);
    if (other === undefined) {
      open.set(edge, corner);
    } else {
      neighbors[corner] = Math.floor(other / 3);
      neighbors[other] = first / 3;
    }
  }
  return neighbors;
}

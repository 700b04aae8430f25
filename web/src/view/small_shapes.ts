import type { Collider, MeshData, Vec3 } from '../../../proto/js/messages.js';

const RINGS = 8; // of a half ball
const SECTORS = 20; // around its axis
const RIGHT_HANDED = [0, 1, 2, 0, 2, 3];

/** Triangles in space, counter-clockwise seen from outside. */
export interface Shape {
  positions: Float32Array;
  triangles: Uint32Array;
}

/** An object as coarsely as a small picture needs it; null for planes. */
export function small_shape(collider: Collider, place: number, data: MeshData): Shape | null {
  switch (collider.kind) {
    case 'plane':
      return null;
    case 'sphere':
      return capsule(collider.center, collider.center, collider.radius);
    case 'capsule':
      return capsule(collider.a, collider.b, collider.radius);
    case 'box':
      return box(collider.center, collider.half_extents, collider.orientation);
    default:
      return data.colliders.find((each) => each.collider === place) ?? null;
  }
}

/** Two half balls and what joins them; a ball, if both ends are one. */
function capsule(a: Vec3, b: Vec3, radius: number): Shape {
  const length = Math.hypot(...a.map((x, axis) => b[axis] - x));
  const along: Vec3 = length > 0 ? (a.map((x, axis) => (b[axis] - x) / length) as Vec3) : [0, 1, 0];
  const helper: Vec3 = Math.abs(along[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0];
  const across = unit(cross(helper, along));
  const third = cross(along, across);
  const positions: number[] = [];
  const triangles: number[] = [];
  for (let ring = 0; ring <= 2 * RINGS + 1; ring++) {
    const upper = ring > RINGS; // the middle ring comes twice, once for each end
    const latitude = ((ring - (upper ? 1 : 0)) / (2 * RINGS) - 0.5) * Math.PI;
    const [high, wide] = [Math.sin(latitude) * radius, Math.cos(latitude) * radius];
    for (let k = 0; k < SECTORS; k++) {
      const [x, y] = [Math.cos((2 * Math.PI * k) / SECTORS), Math.sin((2 * Math.PI * k) / SECTORS)];
      for (const axis of [0, 1, 2])
        positions.push((upper ? b : a)[axis] + high * along[axis] + wide * (x * across[axis] + y * third[axis]));
      if (ring === 0) continue;
      const corner = (row: number, sector: number) => row * SECTORS + (sector % SECTORS);
      const four = [corner(ring - 1, k), corner(ring - 1, k + 1), corner(ring, k + 1), corner(ring, k)];
      triangles.push(...RIGHT_HANDED.map((place) => four[place]));
    }
  }
  return { positions: Float32Array.from(positions), triangles: Uint32Array.from(triangles) };
}

/** Six faces with corners of their own, so that its edges are sharp. */
function box(center: Vec3, half: Vec3, [qx, qy, qz, qw]: number[]): Shape {
  const positions: number[] = [];
  const triangles: number[] = [];
  for (const axis of [0, 1, 2]) {
    for (const side of [-1, 1]) {
      const first = positions.length / 3;
      const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
      for (const [s, t] of [[-1, -1], [side, -side], [1, 1], [-side, side]]) {
        const corner: Vec3 = [0, 0, 0];
        corner[axis] = side * half[axis];
        corner[u] = s * half[u];
        corner[v] = t * half[v];
        const turn = cross([qx, qy, qz], corner).map((x, k) => 2 * x * qw + corner[k]) as Vec3;
        const twice = cross([qx, qy, qz], cross([qx, qy, qz], corner));
        positions.push(...turn.map((x, k) => center[k] + x + 2 * twice[k]));
      }
      triangles.push(...RIGHT_HANDED.map((place) => first + place));
    }
  }
  return { positions: Float32Array.from(positions), triangles: Uint32Array.from(triangles) };
}

function cross(a: Vec3, b: Vec3): Vec3 {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function unit(vector: Vec3): Vec3 {
  const length = Math.hypot(...vector);
  return vector.map((x) => x / length) as Vec3;
}

// Types of the text message `mesh`. proto/README.md gives the meaning and unit of each field.

import type { Vec3 } from './messages.js';

export interface Cloth {
  name: string;
  first_vertex: number;
  vertices: number;
  first_triangle: number;
  triangles: number;
  rows?: number;
  columns?: number;
  thickness: number;
  look?: Look;
}

export type FabricName = 'plain' | 'cotton' | 'silk' | 'denim' | 'wool' | 'leather' | 'nylon';

/** How the author of a cloth wants it drawn. */
export interface Look {
  fabric?: FabricName;
  /** Of the front, from where u runs right and v down, "#rrggbb". */
  color?: string;
  /** Of the other side. */
  back?: string;
}

/** A sphere that should fill the first picture, and the side that it is seen from. */
export interface View {
  target: Vec3;
  /** From the target towards the eye, of unit length. */
  direction: Vec3;
  radius: number;
}

/** `pivot` is the reference point of a pose [m]. */
export type Collider = { name: string; pivot: Vec3 } & (
  | { kind: 'plane'; point: Vec3; normal: Vec3 }
  | { kind: 'sphere'; center: Vec3; radius: number }
  | { kind: 'capsule'; a: Vec3; b: Vec3; radius: number }
  | {
      kind: 'box';
      center: Vec3;
      half_extents: Vec3;
      orientation: [number, number, number, number];
    }
  | { kind: 'mesh'; vertices: number; triangles: number }
);

export interface MeshAnnouncement {
  op: 'mesh';
  epoch: number;
  scene: string;
  hash: string;
  url: string;
  bytes: number;
  vertices: number;
  triangles: number;
  cloths: Cloth[];
  colliders: Collider[];
  view?: View;
}

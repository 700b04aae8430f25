import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Group, Mesh } from 'three';
import type { Cloth, MeshData } from '../../../proto/js/messages.js';
import { fabric_material } from './fabric.js';
import { smooth_normals } from './normals.js';

/** The drawn cloths; all share one buffer of positions and one of normals. */
export class ClothMesh {
  readonly group = new Group();
  readonly triangles: Uint32Array;
  private positions: BufferAttribute;
  private normals: BufferAttribute;

  constructor(cloths: Cloth[], data: MeshData) {
    this.triangles = data.triangles;
    this.positions = new BufferAttribute(data.restPositions.slice(), 3).setUsage(DynamicDrawUsage);
    this.normals = new BufferAttribute(new Float32Array(data.restPositions.length), 3);
    this.normals.setUsage(DynamicDrawUsage);
    const uv = new BufferAttribute(data.uv, 2);
    const index = new BufferAttribute(data.triangles, 1);
    for (const cloth of cloths) {
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', this.positions);
      geometry.setAttribute('normal', this.normals);
      geometry.setAttribute('uv', uv);
      geometry.setIndex(index);
      geometry.setDrawRange(cloth.first_triangle * 3, cloth.triangles * 3);
      const mesh = new Mesh(geometry, fabric_material(...extent(cloth, data)));
      mesh.castShadow = mesh.receiveShadow = true;
      mesh.frustumCulled = false; // bounds would have to follow each frame
      this.group.add(mesh);
    }
    this.update(data.restPositions);
  }

  /** @param positions three values per vertex [m] */
  update(positions: Float32Array): void {
    this.positions.array.set(positions);
    smooth_normals(positions, this.triangles, this.normals.array as Float32Array);
    this.positions.needsUpdate = this.normals.needsUpdate = true;
  }

  dispose(): void {
    this.group.removeFromParent();
    for (const child of this.group.children as Mesh[]) {
      child.geometry.dispose();
      const material = child.material as ReturnType<typeof fabric_material>;
      material.normalMap?.dispose();
      material.dispose();
    }
  }
}

/** Width and height of a cloth in its plane [m]: rest distances of its points per uv. */
function extent(cloth: Cloth, { restPositions, triangles, uv }: MeshData): [number, number] {
  const sums = [0, 0];
  const weights = [0, 0];
  const end = (cloth.first_triangle + cloth.triangles) * 3;
  for (let t = cloth.first_triangle * 3; t < end; t++) {
    const a = triangles[t];
    const b = triangles[t % 3 === 2 ? t - 2 : t + 1];
    const length = Math.hypot(
      ...[0, 1, 2].map((axis) => restPositions[a * 3 + axis] - restPositions[b * 3 + axis]),
    );
    const du = Math.abs(uv[a * 2] - uv[b * 2]);
    const dv = Math.abs(uv[a * 2 + 1] - uv[b * 2 + 1]);
    // Only edges along an axis measure that axis.
    const axis = dv < 1e-3 * du ? 0 : du < 1e-3 * dv ? 1 : -1;
    if (axis < 0) continue;
    sums[axis] += length;
    weights[axis] += axis === 0 ? du : dv;
  }
  return [sums[0] / weights[0] || 1, sums[1] / weights[1] || 1];
}

import { BufferAttribute, BufferGeometry, Vector3 } from 'three';

const SMOOTH_ANGLE = Math.cos((50 * Math.PI) / 180); // sharper edges stay edges

/**
 * A mesh that is smooth across edges where its faces meet at small angles. At sharp edges corners have
 * separate normals. Around a vertex, faces belong together that smooth edges lead to one after the
 * other, so that a bump, whose opposite faces meet at any angle, has no seam.
 * @param positions three values per vertex [m]
 */
export function creased_geometry(positions: Float32Array, triangles: Uint32Array): BufferGeometry {
  const corner = (index: number) => new Vector3().fromArray(positions, triangles[index] * 3);
  const faces: Vector3[] = []; // as long as twice the area
  const around = new Map<number, number[]>();
  for (let t = 0; t < triangles.length; t += 3) {
    const a = corner(t);
    faces.push(corner(t + 1).sub(a).cross(corner(t + 2).sub(a)));
    for (let i = 0; i < 3; i++) {
      const vertex = triangles[t + i];
      around.set(vertex, [...(around.get(vertex) ?? []), t / 3]);
    }
  }
  const directions = faces.map((face) => face.clone().normalize());
  const points = new Float32Array(triangles.length * 3);
  const normals = new Float32Array(triangles.length * 3);
  const normal = new Vector3();
  for (let index = 0; index < triangles.length; index++) {
    corner(index).toArray(points, index * 3);
    const face = Math.floor(index / 3);
    const all = around.get(triangles[index]) ?? [face];
    normal.set(0, 0, 0);
    for (const other of smoothly_joined(face, all, directions, triangles)) normal.add(faces[other]);
    normal.normalize().toArray(normals, index * 3);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(points, 3));
  geometry.setAttribute('normal', new BufferAttribute(normals, 3));
  return geometry;
}

/** The faces around a vertex that smooth edges join to one of them, itself among them. */
function smoothly_joined(
  face: number,
  around: number[],
  directions: Vector3[],
  triangles: Uint32Array,
): number[] {
  const joined = [face];
  for (const one of joined) {
    for (const other of around) {
      if (joined.includes(other) || !share_edge(one, other, triangles)) continue;
      if (directions[one].dot(directions[other]) > SMOOTH_ANGLE) joined.push(other);
    }
  }
  return joined;
}

function share_edge(one: number, other: number, triangles: Uint32Array): boolean {
  let shared = 0;
  for (let i = 0; i < 3; i++) {
    for (let k = 0; k < 3; k++) if (triangles[one * 3 + i] === triangles[other * 3 + k]) shared += 1;
  }
  return shared >= 2;
}

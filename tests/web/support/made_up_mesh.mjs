// A server's mesh without a server.

/** A server's mesh of one square cloth, of so many cells along a side, and objects. */
export function mesh_of(cells, colliders) {
  const side = cells + 1;
  const place_of = (i) => [(i % side) / cells, Math.floor(i / side) / cells];
  const points = Array.from({ length: side * side }, (_, i) => place_of(i));
  const triangles = [];
  for (let y = 0; y < cells; y++) {
    for (let x = 0; x < cells; x++) {
      const a = y * side + x;
      triangles.push(a, a + 1, a + side, a + 1, a + side + 1, a + side);
    }
  }
  const cloth = { name: 'cloth', first_vertex: 0, first_triangle: 0, thickness: 0.004 };
  const size = { vertices: side * side, triangles: triangles.length / 3 };
  return {
    announcement: { scene: 'made up', ...size, cloths: [{ ...cloth, ...size }], colliders },
    data: {
      restPositions: Float32Array.from(points.flatMap(([u, v]) => [u, 1, v])),
      triangles: Uint32Array.from(triangles),
      uv: Float32Array.from(points.flat()),
      colliders: [],
    },
  };
}

const CORNER = Math.cos(Math.PI / 4); // of a turn that is a corner

/** The vertex that follows each one on the borders, in the direction of its triangle. */
export function border_of(triangles: Uint32Array): Map<number, number> {
  let most = 0;
  for (const vertex of triangles) most = Math.max(most, vertex + 1);
  const open = new Map<number, [number, number]>();
  for (let t = 0; t < triangles.length; t++) {
    const a = triangles[t];
    const b = triangles[t % 3 === 2 ? t - 2 : t + 1];
    if (!open.delete(b * most + a)) open.set(a * most + b, [a, b]);
  }
  return new Map(open.values());
}

export function reversed(next: Map<number, number>): Map<number, number> {
  return new Map([...next].map(([a, b]) => [b, a]));
}

/** Vertices where a border turns in the plane of the cloth. @param uv two values per vertex */
export function corners_of(triangles: Uint32Array, uv: Float32Array): Set<number> {
  const next = border_of(triangles);
  const before = reversed(next);
  const corners = new Set<number>();
  for (const [at, after] of next) {
    const from = before.get(at) ?? at;
    const [ax, ay] = [uv[at * 2] - uv[from * 2], uv[at * 2 + 1] - uv[from * 2 + 1]];
    const [bx, by] = [uv[after * 2] - uv[at * 2], uv[after * 2 + 1] - uv[at * 2 + 1]];
    const along = ax * bx + ay * by;
    if (along <= CORNER * Math.hypot(ax, ay) * Math.hypot(bx, by)) corners.add(at);
  }
  return corners;
}

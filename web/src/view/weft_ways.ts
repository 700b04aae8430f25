import { BufferAttribute, DynamicDrawUsage } from 'three';

/**
 * Directions of the weft over cloths, of any length, for highlights that are longer along the threads.
 * They are means over the triangles around each vertex: a triangle's own change from one to the
 * next, which shows where the cloth is seen at a slant.
 */
export class WeftWays {
  readonly attribute: BufferAttribute;
  /** Two numbers per triangle, by which the sum of its edges from its first corner is its weft. */
  private shares: Float32Array;

  /**
   * @param uv       of the simulated cloths, two values per vertex
   * @param vertices of what is drawn; the simulated ones come first
   */
  constructor(private triangles: Uint32Array, uv: Float32Array, vertices: number) {
    this.attribute = new BufferAttribute(new Float32Array(vertices * 3), 3).setUsage(DynamicDrawUsage);
    this.shares = new Float32Array((triangles.length / 3) * 2);
    for (let t = 0, to = 0; t < triangles.length; t += 3, to += 2) {
      const [a, b, c] = [triangles[t] * 2, triangles[t + 1] * 2, triangles[t + 2] * 2];
      const [bu, bv, cu, cv] = [uv[b] - uv[a], uv[b + 1] - uv[a + 1], uv[c] - uv[a], uv[c + 1] - uv[a + 1]];
      const turn = Math.sign(bu * cv - cu * bv);
      this.shares[to] = turn * cv;
      this.shares[to + 1] = -turn * bv;
    }
  }

  /**
   * @param positions three values per simulated vertex, at least [m]
   * @param fill      fills in what is drawn besides, from the values at simulated vertices
   */
  update(positions: Float32Array, fill: (values: Float32Array) => void): void {
    const { triangles, shares } = this;
    const ways = this.attribute.array as Float32Array;
    ways.fill(0);
    for (let t = 0, k = 0; t < triangles.length; t += 3, k += 2) {
      const a = triangles[t] * 3;
      const b = triangles[t + 1] * 3;
      const c = triangles[t + 2] * 3;
      for (let axis = 0; axis < 3; axis++) {
        const from = positions[a + axis];
        const way = shares[k] * (positions[b + axis] - from) + shares[k + 1] * (positions[c + axis] - from);
        ways[a + axis] += way;
        ways[b + axis] += way;
        ways[c + axis] += way;
      }
    }
    fill(ways);
    this.attribute.needsUpdate = true;
  }
}

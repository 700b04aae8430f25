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
      const to_b = shares[k];
      const to_c = shares[k + 1];
      const of_a = -to_b - to_c;
      const x = of_a * positions[a] + to_b * positions[b] + to_c * positions[c];
      const y = of_a * positions[a + 1] + to_b * positions[b + 1] + to_c * positions[c + 1];
      const z = of_a * positions[a + 2] + to_b * positions[b + 2] + to_c * positions[c + 2];
      ways[a] += x;
      ways[a + 1] += y;
      ways[a + 2] += z;
      ways[b] += x;
      ways[b + 1] += y;
      ways[b + 2] += z;
      ways[c] += x;
      ways[c + 1] += y;
      ways[c + 2] += z;
    }
    fill(ways);
    this.attribute.needsUpdate = true;
  }
}

import type { Camera } from 'three';

const STEPS = 4096; // of depth, between the nearest and the farthest triangle

/** Puts triangles in order from far to near, so that cloth shows through cloth. */
export class DepthOrder {
  private steps: Uint16Array;
  private depths: Float32Array; // of the vertices; six triangles share one
  private sums: Float32Array; // of the depths of a triangle's three
  private counts = new Uint32Array(STEPS + 1);

  /** @param triangles in any order */
  constructor(private triangles: Uint32Array) {
    this.steps = new Uint16Array(triangles.length / 3);
    this.sums = new Float32Array(triangles.length / 3);
    this.depths = new Float32Array(triangles.reduce((most, vertex) => Math.max(most, vertex + 1), 0));
  }

  /**
   * @param positions three values per vertex [m]
   * @param ordered   out; as many as the triangles
   * @returns how near the middle of all is: greater for what is nearer to the eye [m]
   */
  sort(camera: Camera, positions: Float32Array, ordered: Uint32Array): number {
    const { triangles, steps, counts } = this;
    const nearness = this.measure(camera, positions);
    counts.fill(0);
    for (let t = 0; t < steps.length; t++) counts[steps[t] + 1] += 1;
    for (let k = 0; k < STEPS; k++) counts[k + 1] += counts[k];
    for (let t = 0; t < steps.length; t++) {
      const to = counts[steps[t]]++ * 3;
      ordered[to] = triangles[t * 3];
      ordered[to + 1] = triangles[t * 3 + 1];
      ordered[to + 2] = triangles[t * 3 + 2];
    }
    return nearness;
  }

  /** Steps of depth, 0 for the farthest; returns the mean of the depths. */
  private measure(camera: Camera, positions: Float32Array): number {
    const { triangles, steps, depths, sums } = this;
    const view = camera.matrixWorldInverse.elements;
    const [x, y, z] = [view[2], view[6], view[10]]; // towards the eye
    for (let v = 0, at = 0; v < depths.length; v++, at += 3) {
      depths[v] = positions[at] * x + positions[at + 1] * y + positions[at + 2] * z;
    }
    let far = Infinity;
    let near = -Infinity;
    let total = 0;
    for (let t = 0, at = 0; t < sums.length; t++, at += 3) {
      const sum = depths[triangles[at]] + depths[triangles[at + 1]] + depths[triangles[at + 2]];
      sums[t] = sum;
      total += sum;
      if (sum < far) far = sum;
      if (sum > near) near = sum;
    }
    const scale = (STEPS - 1) / (near - far || 1);
    for (let t = 0; t < sums.length; t++) steps[t] = (sums[t] - far) * scale;
    return total / (3 * sums.length || 1);
  }
}

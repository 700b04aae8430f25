import type { Camera } from 'three';

const STEPS = 4096; // of depth, between the nearest and the farthest triangle

/** Puts triangles in order from far to near, so that cloth shows through cloth. */
export class DepthOrder {
  private steps: Uint16Array;
  private depths: Float32Array;
  private counts = new Uint32Array(STEPS + 1);

  /** @param triangles in any order */
  constructor(private triangles: Uint32Array) {
    this.steps = new Uint16Array(triangles.length / 3);
    this.depths = new Float32Array(triangles.length / 3);
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
    const { triangles, steps, depths } = this;
    const view = camera.matrixWorldInverse.elements;
    const [x, y, z] = [view[2], view[6], view[10]]; // towards the eye
    let far = Infinity;
    let near = -Infinity;
    let sum = 0;
    for (let t = 0; t < depths.length; t++) {
      const a = triangles[t * 3] * 3;
      const b = triangles[t * 3 + 1] * 3;
      const c = triangles[t * 3 + 2] * 3;
      const depth =
        (positions[a] + positions[b] + positions[c]) * x +
        (positions[a + 1] + positions[b + 1] + positions[c + 1]) * y +
        (positions[a + 2] + positions[b + 2] + positions[c + 2]) * z;
      depths[t] = depth;
      sum += depth / 3;
      if (depth < far) far = depth;
      if (depth > near) near = depth;
    }
    const scale = (STEPS - 1) / (near - far || 1);
    for (let t = 0; t < depths.length; t++) steps[t] = (depths[t] - far) * scale;
    return sum / (depths.length || 1);
  }
}

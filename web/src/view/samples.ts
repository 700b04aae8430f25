/** Where one of the pictures is taken whose mean is shown at rest; pairs are in a disc of radius 1. */
export interface Sample {
  /** Shift of the picture, -0.5 to 0.5 [pixels]. */
  pixel: [number, number];
  /** Point of the key light's area. */
  key: [number, number];
  /** Point of the area of the light from above. */
  sky: [number, number];
}

/** The k-th of a sequence that fills pixel and lights evenly, however early it ends. */
export function sample_of(k: number): Sample {
  return {
    pixel: [radical_inverse(k, 2) - 0.5, radical_inverse(k, 3) - 0.5],
    key: in_disc(radical_inverse(k, 5), radical_inverse(k, 7)),
    sky: in_disc(radical_inverse(k, 3), radical_inverse(k, 2)),
  };
}

/** The digits of k in a base, mirrored at the point: Halton's sequence. */
function radical_inverse(k: number, base: number): number {
  let [value, part] = [0, 1 / base];
  for (let rest = k + 1; rest > 0; rest = Math.floor(rest / base)) {
    value += (rest % base) * part;
    part /= base;
  }
  return value;
}

/** Evenly over the disc of radius 1. */
function in_disc(u: number, v: number): [number, number] {
  const [radius, angle] = [Math.sqrt(u), 2 * Math.PI * v];
  return [radius * Math.cos(angle), radius * Math.sin(angle)];
}

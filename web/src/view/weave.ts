import {
  DataTexture,
  LinearFilter,
  LinearMipmapLinearFilter,
  RepeatWrapping,
} from 'three';
import type { FabricName } from '../../../proto/js/messages.js';

const SIZE = 256; // pixels of a tile

/** A tile of a weave. Its texture holds the normal's x and y, whether weft is on top, and height. */
export interface Weave {
  texture: DataTexture;
  /** Periods of the weave in a tile. */
  periods: number;
  /** Mean share of weft on top. */
  weft: number;
}

/** Height of a tile's point and whether weft is on top, from u, v in periods of the weave. */
type Relief = (u: number, v: number) => { height: number; weft: number };

const TILES: Record<FabricName, { periods: number; slope: number; relief: Relief }> = {
  plain: { periods: 12, slope: 1, relief: threads(12, 2, (i, j) => (i + j) % 2 === 0, 0.3) },
  cotton: { periods: 16, slope: 1, relief: threads(16, 2, (i, j) => (i + j) % 2 === 0, 0.12) },
  denim: { periods: 8, slope: 1, relief: threads(8, 4, (i, j) => (i + j) % 4 !== 0, 0.25) },
  wool: { periods: 8, slope: 0.8, relief: fuzzy(threads(8, 4, (i, j) => (i + j) % 4 < 2, 0.2), 8) },
  silk: { periods: 32, slope: 1, relief: satin(32) },
  leather: { periods: 12, slope: 1, relief: grain(12) },
  nylon: { periods: 8, slope: 1, relief: ripstop(8) },
};

export function weave_of(name: FabricName): Weave {
  const { periods, slope, relief } = TILES[name];
  const heights = new Float32Array(SIZE * SIZE);
  const wefts = new Float32Array(SIZE * SIZE);
  for (let y = 0, k = 0; y < SIZE; y++) {
    for (let x = 0; x < SIZE; x++, k++) {
      const { height, weft } = relief((x / SIZE) * periods, (y / SIZE) * periods);
      heights[k] = height;
      wefts[k] = weft;
    }
  }
  const steepness = (slope * SIZE) / (periods * 8);
  return { texture: texture_of(heights, wefts, steepness), periods, weft: mean(wefts) };
}

function mean(values: Float32Array): number {
  return values.reduce((sum, value) => sum + value, 0) / values.length;
}

function texture_of(heights: Float32Array, wefts: Float32Array, steepness: number): DataTexture {
  const pixels = new Uint8Array(SIZE * SIZE * 4);
  const middle = mean(heights);
  const at = (x: number, y: number) => heights[((y + SIZE) % SIZE) * SIZE + ((x + SIZE) % SIZE)];
  const byte = (value: number) => Math.round(Math.min(1, Math.max(0, value)) * 255);
  for (let y = 0, k = 0; y < SIZE; y++) {
    for (let x = 0; x < SIZE; x++, k++) {
      const slope_x = (at(x + 1, y) - at(x - 1, y)) * steepness;
      const slope_y = (at(x, y + 1) - at(x, y - 1)) * steepness;
      const length = Math.sqrt(slope_x * slope_x + slope_y * slope_y + 1);
      pixels[k * 4] = byte(0.5 - slope_x / length / 2);
      pixels[k * 4 + 1] = byte(0.5 - slope_y / length / 2);
      pixels[k * 4 + 2] = byte(wefts[k]);
      pixels[k * 4 + 3] = byte(0.5 + heights[k] - middle);
    }
  }
  const texture = new DataTexture(pixels, SIZE, SIZE);
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.magFilter = LinearFilter;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  texture.anisotropy = 8;
  texture.needsUpdate = true;
  return texture;
}

/** A number of 0 to 1 that belongs to a cell of a tile, always the same one. */
function chance(x: number, y: number, salt: number): number {
  let h = Math.imul(x, 374761393) + Math.imul(y, 668265263) + Math.imul(salt, 2147483647);
  h = Math.imul(h ^ (h >>> 13), 1274126177);
  return ((h ^ (h >>> 16)) >>> 0) / 4294967296;
}

/** Smooth noise of 0 to 1 whose cells repeat after so many. */
function noise(x: number, y: number, cells: number, salt: number): number {
  const [i, j] = [Math.floor(x), Math.floor(y)];
  const ease = (t: number) => t * t * (3 - 2 * t);
  const [s, t] = [ease(x - i), ease(y - j)];
  const corner = (a: number, b: number) =>
    chance((((i + a) % cells) + cells) % cells, (((j + b) % cells) + cells) % cells, salt);
  const low = corner(0, 0) * (1 - s) + corner(1, 0) * s;
  const high = corner(0, 1) * (1 - s) + corner(1, 1) * s;
  return low * (1 - t) + high * t;
}

/**
 * Round threads that pass over and under each other.
 * @param periods in a tile
 * @param count   of threads in a period
 * @param warp_on_top at the crossing of the i-th warp and the j-th weft
 * @param uneven  by how much threads differ in thickness, 0 to 1
 */
function threads(
  periods: number,
  count: number,
  warp_on_top: (i: number, j: number) => boolean,
  uneven: number,
): Relief {
  const all = periods * count;
  const wrap = (k: number) => ((k % all) + all) % all;
  const thickness = (k: number, along: number, salt: number) =>
    1 - uneven * noise(k + 0.5, along / 4, all / 4, salt);
  /** How far the middle of the thread's float is: 0 at its ends, where it dives. */
  const crown = (over: (k: number) => boolean, at: number) => {
    const k = Math.floor(at);
    if (!over(k)) return 0;
    let [first, last] = [k, k + 1];
    while (over(first - 1) && k - first < count) first -= 1;
    while (over(last) && last - k < count) last += 1;
    return Math.sin((Math.PI * (at - first)) / (last - first));
  };
  return (u, v) => {
    const [x, y] = [v * count, u * count]; // the warp runs along u
    const [i, j] = [Math.floor(x), Math.floor(y)];
    const warp = warp_on_top(wrap(i), wrap(j));
    const across = warp ? x - i : y - j;
    const float = warp
      ? crown((k) => warp_on_top(wrap(i), wrap(k)), y)
      : crown((k) => !warp_on_top(wrap(k), wrap(j)), x);
    const wide = warp ? thickness(i, y, 1) : thickness(j, x, 2);
    const from_middle = Math.min(1, Math.abs(across - 0.5) * (2 / wide));
    const round = 1 - from_middle * from_middle;
    const [thread, along] = warp ? [i, y] : [j + all, x];
    const fibres = Math.sin(2 * Math.PI * (along + across + chance(wrap(thread), 0, 11)));
    const tone = chance(wrap(thread), warp ? 1 : 2, 12) - 0.5;
    const height = (0.1 + 0.9 * round) * (0.5 + 0.5 * float) * wide;
    return { height: height + (0.06 * fibres + 0.14 * tone) * round, weft: warp ? 0 : 1 };
  };
}

/** Wool: what lies below, under fibres that stand off. */
function fuzzy(below: Relief, periods: number): Relief {
  return (u, v) => {
    const { height, weft } = below(u, v);
    const fibres =
      noise(u * 4, v * 4, periods * 4, 3) * 0.6 +
      noise(u * 9 + v * 3, v * 9, periods * 3, 4) * 0.3 +
      noise(u * 12, v * 12, periods * 12, 5) * 0.1;
    return { height: height * 0.45 + fibres * 0.6, weft };
  };
}

/** Satin: long floats of fine warp, so that only lines along it are seen. */
function satin(periods: number): Relief {
  return (u, v) => {
    const across = Math.sin(Math.PI * (v - Math.floor(v)));
    const fine = noise(u / 2, v * 2, periods / 2, 6);
    return { height: across * 0.7 + fine * 0.3, weft: 0 };
  };
}

/** Leather: plump cells of uneven size with grooves between them, and pores. */
function grain(periods: number): Relief {
  const wrap = (k: number) => ((k % periods) + periods) % periods;
  return (u, v) => {
    const x = u + 0.35 * noise(u * 2, v * 2, periods * 2, 7);
    const y = v + 0.35 * noise(u * 2, v * 2, periods * 2, 13);
    const [i, j] = [Math.floor(x), Math.floor(y)];
    let [nearest, second] = [Infinity, Infinity];
    for (let b = -1; b <= 1; b++) {
      for (let a = -1; a <= 1; a++) {
        const [p, q] = [wrap(i + a), wrap(j + b)];
        const dx = i + a + 0.2 + 0.6 * chance(p, q, 8) - x;
        const dy = j + b + 0.2 + 0.6 * chance(p, q, 9) - y;
        const distance = Math.sqrt(dx * dx + dy * dy);
        if (distance < nearest) [second, nearest] = [nearest, distance];
        else if (distance < second) second = distance;
      }
    }
    const inside = Math.min(1, (second - nearest) * 1.6);
    const plump = Math.sin((Math.PI / 2) * inside);
    const size = chance(wrap(i), wrap(j), 14) * 0.1;
    const pores = noise(u * 8, v * 8, periods * 8, 10);
    return { height: plump * 0.7 + size + pores * 0.15, weft: 0 };
  };
}

/** Ripstop: a fine weave with a grid of thicker threads. */
function ripstop(periods: number): Relief {
  const fine = threads(periods, 8, (i, j) => (i + j) % 2 === 0, 0.1);
  const ridge = (at: number) => {
    const from_line = Math.abs(at - Math.round(at)) / 0.09;
    return from_line < 1 ? Math.sqrt(1 - from_line * from_line) : 0;
  };
  return (u, v) => {
    const { height } = fine(u, v);
    return { height: Math.max(height * 0.18, 0.8 * ridge(u), 0.8 * ridge(v)), weft: 0 };
  };
}

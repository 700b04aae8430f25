import { camera_at_rest, read, until } from './browser.mjs';
import { cloths_in_pixels, drawn_cloth, picture_of } from './silhouette.mjs';

// What can be measured on the page's picture of cloth: colours, highlights, folds and weaves.

const linear = Array.from({ length: 256 }, (_, byte) => {
  const value = byte / 255;
  return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
});

/** Brightness of a pixel as video has it, 0 to 255. */
const luma = (data, pixel) =>
  0.2126 * data[pixel * 4] + 0.7152 * data[pixel * 4 + 1] + 0.0722 * data[pixel * 4 + 2];

/** CIELAB of linear red, green and blue, for the white of sRGB. */
export function lab_of([r, g, b]) {
  const root = (t) => (t > 216 / 24389 ? Math.cbrt(t) : ((24389 / 27) * t + 16) / 116);
  const x = root((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505);
  const y = root(0.2126 * r + 0.7152 * g + 0.0722 * b);
  const z = root((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

/** Distance in CIELAB (CIE 1976). */
export const difference = (one, other) => Math.hypot(...one.map((value, k) => value - other[k]));

/** Part of the page's picture that is cloth, 0 to 1. */
export async function fill_of(page) {
  const pixels = await drawn_cloth(page);
  return pixels.reduce((sum, pixel) => sum + pixel, 0) / pixels.length;
}

/** A fine picture of the page at rest, and the number of the cloth in each of its pixels. */
export async function picture_of_cloths(page) {
  await page.mouse.move(1, 1);
  await camera_at_rest(page);
  await until(() => read(page, 'fine'), 'the picture is a fine one');
  return { ...(await picture_of(page)), cloths: await cloths_in_pixels(page) };
}

/** Mean colour of each cloth in a picture, in CIELAB, with its number of pixels. */
export function colors_in({ data, cloths }) {
  const sums = new Map();
  for (const [pixel, cloth] of cloths.entries()) {
    if (cloth === 0) continue;
    const sum = sums.get(cloth) ?? { color: [0, 0, 0], pixels: 0 };
    for (let part = 0; part < 3; part++) sum.color[part] += linear[data[pixel * 4 + part]];
    sum.pixels += 1;
    sums.set(cloth, sum);
  }
  return new Map([...sums].map(([cloth, { color, pixels }]) =>
    [cloth, { pixels, lab: lab_of(color.map((part) => part / pixels)) }]));
}

/** Lumas of the cloth's pixels, in order, without those at its outline. */
function lumas_in({ data, width, cloths }) {
  const inside = [];
  for (const [pixel, cloth] of cloths.entries()) {
    const around = [-1, 1, -width, width].every((step) => cloths[pixel + step] === cloth);
    if (cloth > 0 && around) inside.push(luma(data, pixel));
  }
  return inside.sort((a, b) => a - b);
}

/** Luma below which a part of the cloth's pixels lies. */
export function luma_at(picture, part) {
  const lumas = lumas_in(picture);
  return lumas[Math.floor(part * (lumas.length - 1))];
}

/** How much more light comes from the brightest 0.5 % of the cloth than from its middle: a ratio. */
export function highlight_in(picture) {
  const [middle, bright] = [0.5, 0.995].map((part) => linear[Math.round(luma_at(picture, part))]);
  return bright / middle;
}

/**
 * Spacing of threads, or of a grain [pixels]: the wavelength that stands out most in a square of the
 * picture, by a Fourier transform of its luma. Longer ones than a quarter of the square, which are
 * light and folds, do not count.
 */
export function weave_spacing({ data, width, height }, size = 160) {
  const [left, top] = [Math.floor((width - size) / 2), Math.floor((height - size) / 2)];
  const rows = Array.from({ length: size }, (_, y) =>
    Float64Array.from({ length: size }, (_, x) => {
      const window = Math.sin((Math.PI * (x + 0.5)) / size) * Math.sin((Math.PI * (y + 0.5)) / size);
      return luma(data, (top + y) * width + left + x) * window;
    }));
  const spectrum = transform(rows, size);
  let [strongest, period] = [0, Infinity];
  for (let v = -size / 2 + 1; v < size / 2; v++) {
    for (let u = 0; u < size / 2; u++) {
      const frequency = Math.hypot(u, v);
      if (frequency < 4) continue;
      // Of natural pictures power falls with the frequency; a weave stands out above that.
      const power = spectrum(u, v) * frequency;
      if (power > strongest) [strongest, period] = [power, size / frequency];
    }
  }
  return period;
}

/** Power of a real picture at frequencies u from 0, v of either sign. */
function transform(rows, size) {
  const turn = (k) => (2 * Math.PI * k) / size;
  const cosines = Float64Array.from({ length: size }, (_, k) => Math.cos(turn(k)));
  const sines = Float64Array.from({ length: size }, (_, k) => Math.sin(turn(k)));
  const half = size / 2;
  const along = rows.map((row) => {
    const [real, imaginary] = [new Float64Array(half), new Float64Array(half)];
    for (let u = 0; u < half; u++) {
      for (let x = 0; x < size; x++) {
        real[u] += row[x] * cosines[(u * x) % size];
        imaginary[u] -= row[x] * sines[(u * x) % size];
      }
    }
    return { real, imaginary };
  });
  return (u, v) => {
    let [real, imaginary] = [0, 0];
    for (let y = 0; y < size; y++) {
      const k = (((v * y) % size) + size) % size;
      real += along[y].real[u] * cosines[k] + along[y].imaginary[u] * sines[k];
      imaginary += along[y].imaginary[u] * cosines[k] - along[y].real[u] * sines[k];
    }
    return real * real + imaginary * imaginary;
  };
}

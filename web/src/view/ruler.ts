export type Point = [number, number, number];

const SHORT = 0.004; // marks of centimetres [m]
const MIDDLE = 0.007; // of each fifth
const LONG = 0.01; // of each tenth
const DIGIT = 0.007; // height of a digit [m]
const CIRCLE_PARTS = 72;

// Strokes of the digits, pairs of points on a grid one wide and two high, from the upper left.
const STROKES: Record<string, number[]> = {
  0: [0, 0, 1, 0, 1, 0, 1, 2, 1, 2, 0, 2, 0, 2, 0, 0],
  1: [0.5, 0, 0.5, 2],
  2: [0, 0, 1, 0, 1, 0, 1, 1, 1, 1, 0, 1, 0, 1, 0, 2, 0, 2, 1, 2],
  3: [0, 0, 1, 0, 1, 0, 1, 2, 1, 2, 0, 2, 0, 1, 1, 1],
  4: [0, 0, 0, 1, 0, 1, 1, 1, 1, 0, 1, 2],
  5: [1, 0, 0, 0, 0, 0, 0, 1, 0, 1, 1, 1, 1, 1, 1, 2, 1, 2, 0, 2],
  6: [1, 0, 0, 0, 0, 0, 0, 2, 0, 2, 1, 2, 1, 2, 1, 1, 1, 1, 0, 1],
  7: [0, 0, 1, 0, 1, 0, 1, 2],
  8: [0, 0, 1, 0, 1, 0, 1, 2, 1, 2, 0, 2, 0, 2, 0, 0, 0, 1, 1, 1],
  9: [1, 1, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 1, 2],
};

/**
 * A ruler with a mark for each centimetre and a number at each fifth, as pairs of points.
 * @param start  of its edge [m]
 * @param along  unit vector of its edge
 * @param across unit vector in which the marks point, at right angles to its edge
 * @param length [m]
 */
export function ruler(start: Point, along: Point, across: Point, length: number): number[] {
  const at = (u: number, v: number) =>
    start.map((value, axis) => value + u * along[axis] + v * across[axis]);
  const points = [...at(0, 0), ...at(length, 0)];
  const last = Math.floor(length * 100 + 1e-6);
  for (let centimetre = 0; centimetre <= last; centimetre++) {
    const u = centimetre / 100;
    const mark = centimetre % 10 === 0 ? LONG : centimetre % 5 === 0 ? MIDDLE : SHORT;
    points.push(...at(u, 0), ...at(u, mark));
    if (centimetre % 5 === 0) points.push(...number_at(String(centimetre), u, LONG, at, along, across));
  }
  return points;
}

/** Writes a number beside a mark, upright whichever way the ruler runs. */
function number_at(
  text: string,
  u: number,
  v: number,
  at: (u: number, v: number) => number[],
  along: Point,
  across: Point,
): number[] {
  const size = DIGIT / 2;
  const pitch = 1.5 * size;
  const lies = Math.abs(along[1]) < 0.5; // the edge is level, so numbers are written along it
  const up = across[1] > 0.5;
  const width = pitch * text.length - 0.5 * size;
  const points: number[] = [];
  [...text].forEach((digit, place) => {
    const strokes = STROKES[digit];
    for (let i = 0; i < strokes.length; i += 2) {
      const right = place * pitch + strokes[i] * size;
      const down = strokes[i + 1] * size;
      const gap = v + 0.5 * size;
      if (lies) points.push(...at(u + right - width / 2, gap + (up ? DIGIT - down : down)));
      else points.push(...at(u + down - DIGIT / 2, gap + right));
    }
  });
  return points;
}

/** A level circle as pairs of points. @param radius [m] */
export function circle([x, y, z]: Point, radius: number): number[] {
  const points: number[] = [];
  for (let part = 0; part < CIRCLE_PARTS; part++) {
    for (const end of [part, part + 1]) {
      const turn = (2 * Math.PI * end) / CIRCLE_PARTS;
      points.push(x + radius * Math.cos(turn), y, z + radius * Math.sin(turn));
    }
  }
  return points;
}

// What the codec `packed` expects of a vertex (proto/README.md section 10): from its neighbours, and
// from earlier frames.

const STEP = 1;
export const STRAIGHT = 2;
const NONE = 0;
const MEAN = 1;
const CORNER = 2;
export const BLEND = 3;

/** @typedef {import('./entropy.js').Order} Order */

/** @param {number} v */
const unzigzag = (v) => (v >>> 1) ^ -(v & 1);

/**
 * Residuals to differences by the neighbours that the order tells.
 * @param {number} neighbours
 * @param {Order} order
 * @param {Int32Array} values  of one component
 */
function addByPlace(neighbours, { vertices, a, b, c }, values) {
  // A loop for each, because engines leave the choice inside.
  const count = vertices.length;
  if (neighbours === CORNER) {
    for (let i = 0; i < count; ++i)
      values[i] = unzigzag(values[i]) + values[a[i]] + values[b[i]] - values[c[i]];
  } else if (neighbours === MEAN) {
    for (let i = 0; i < count; ++i) {
      const sum = (values[a[i]] + values[b[i]]) | 0;
      values[i] = unzigzag(values[i]) + (b[i] === count ? sum : sum >> 1);
    }
  } else if (neighbours === BLEND) {
    for (let i = 0; i < count; ++i) {
      const sum = (values[a[i]] + values[b[i]]) | 0;
      const blend = (Math.imul(3, sum) - (values[c[i]] << 1) + 2) >> 2;
      values[i] = unzigzag(values[i]) + (b[i] === count ? sum : blend);
    }
  } else {
    for (let i = 0; i < count; ++i) values[i] = unzigzag(values[i]);
  }
}

/**
 * One row of a grid but its first vertex. What a vertex and the next one share stays in a register;
 * to look it up, as meshes have to, takes four times as long.
 * @param {number} neighbours
 * @param {Int32Array} values
 * @param {number} first    place of the row
 * @param {number} columns
 */
function addRow(neighbours, values, first, columns) {
  const end = first + columns;
  let left = values[first];
  if (neighbours === MEAN) {
    for (let i = first + 1; i < end; ++i) {
      const sum = (left + values[i - columns]) | 0;
      values[i] = left = (unzigzag(values[i]) + (sum >> 1)) | 0;
    }
    return;
  }
  let corner = values[first - columns];
  for (let i = first + 1; i < end; ++i) {
    const above = values[i - columns];
    const sum = (left + above) | 0;
    const guess =
      neighbours === CORNER ? sum - corner : (Math.imul(3, sum) - (corner << 1) + 2) >> 2;
    values[i] = left = (unzigzag(values[i]) + guess) | 0;
    corner = above;
  }
}

/**
 * Residuals to differences of a grid. Its first row and column have one neighbour each.
 * @param {number} neighbours
 * @param {import('./entropy.js').Grid} grid
 * @param {Int32Array} values
 */
function addByRow(neighbours, { first, end, columns }, values) {
  let left = 0;
  for (let i = first; i < Math.min(first + columns, end); ++i)
    values[i] = left = (unzigzag(values[i]) + left) | 0;
  for (let row = first + columns; row < end; row += columns) {
    values[row] = unzigzag(values[row]) + values[row - columns];
    addRow(neighbours, values, row, columns);
  }
}

/**
 * Residuals to differences, in place; arithmetic is modulo 2^32. Neighbours come before.
 * @param {number} neighbours
 * @param {Order} order
 * @param {Int32Array} values  of one component
 */
export function addNeighbours(neighbours, order, values) {
  if (!order.grids || neighbours === NONE) return addByPlace(neighbours, order, values);
  for (const grid of order.grids) addByRow(neighbours, grid, values);
}

/**
 * Adds what was expected from earlier frames.
 * @param {number} base
 * @param {Int32Array} values
 * @param {Int32Array} last
 * @param {Int32Array} before
 */
export function addEarlier(base, values, last, before) {
  const count = values.length;
  if (base === STEP) for (let i = 0; i < count; ++i) values[i] = values[i] + last[i];
  if (base !== STRAIGHT) return;
  for (let i = 0; i < count; ++i) values[i] = values[i] + (last[i] << 1) - before[i];
}

// In which order the codec `packed` takes vertices (proto/README.md section 10).

import { demand } from './bytes.js';

const MISSING = 0xffffffff;

/**
 * @typedef {import('./entropy.js').Order} Order
 * @typedef {{first_vertex: number, vertices: number, rows?: number, columns?: number}} Cloth
 */

/**
 * @param {number} count
 * @returns {Order}
 */
function emptyOrder(count) {
  const vertices = new Uint32Array(count);
  const [a, b, c] = [0, 1, 2].map(() => new Uint32Array(count).fill(count));
  return { vertices, a, b, c, grids: null };
}

/**
 * The order of a mesh that tells it.
 * @param {Uint32Array} words  of section 21
 * @returns {Order}
 */
export function readOrder(words) {
  const count = words.length / 4;
  const order = emptyOrder(count);
  const taken = new Uint8Array(count);
  /** @type {(word: number, place: number) => number} */
  const neighbour = (word, place) => {
    demand(word < place || word === MISSING, 'a neighbour does not come before');
    return word === MISSING ? count : word;
  };
  for (let i = 0; i < count; ++i) {
    const [vertex, a, b, c] = words.subarray(4 * i, 4 * i + 4);
    demand(vertex < count && taken[vertex] === 0, 'the order is none of the vertices');
    taken[vertex] = 1;
    order.vertices[i] = vertex;
    order.a[i] = neighbour(a, i);
    order.b[i] = neighbour(b, i);
    order.c[i] = neighbour(c, i);
  }
  return order;
}

/** @param {Cloth} cloth */
function gridOf({ first_vertex: first, vertices, columns = 0 }) {
  return { first, end: first + vertices, columns };
}

/**
 * The order of a mesh, as announced and as sent.
 * @param {Cloth[]} cloths
 * @param {{restPositions: Float32Array, order: Uint32Array | null}} data
 * @returns {Order}
 */
export function orderOf(cloths, data) {
  if (data.order) return readOrder(data.order);
  const count = data.restPositions.length / 3;
  const order = { ...emptyOrder(count), grids: cloths.map(gridOf) };
  let place = 0;
  for (const { first_vertex: first, vertices, rows = 0, columns = 0 } of cloths) {
    const grid = first === place && place + vertices <= count && rows * columns === vertices;
    demand(grid, 'a cloth without an order is no grid');
    for (let i = 0; i < vertices; ++i, ++place) {
      order.vertices[place] = place;
      const left = i % columns > 0;
      const above = i >= columns;
      if (left || above) order.a[place] = left ? place - 1 : place - columns;
      if (!left || !above) continue;
      order.b[place] = place - columns;
      order.c[place] = place - columns - 1;
    }
  }
  demand(place === count, 'the cloths are not all of the mesh');
  return order;
}

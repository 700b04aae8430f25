import assert from 'node:assert/strict';
import test from 'node:test';
import { grid, refined } from './support/grids.mjs';
import { require_package } from './support/packages.mjs';
import { import_page_module } from './support/page_module.mjs';

// How cloth is drawn, without a browser: looks, weaves, and the finer mesh that is displayed.

const { back_of, colors_of, FINISHES, PALETTE } = await import_page_module('view/looks');
const { difference, lab_of } = await import_page_module('view/color');
const { fabric_material } = await import_page_module('view/fabric');
const { weave_of } = await import_page_module('view/weave');
const { corners_of } = await import_page_module('view/border');
const { both_diagonals, cells_of } = await import_page_module('view/cells');
const { round_of } = await import_page_module('view/round');
const { Hem } = await import_page_module('view/hem');
const { even_normals, smooth_normals } = await import_page_module('view/normals');
const { fabric_extent } = await import_page_module('view/rest_shape');
const { WeftWays } = await import_page_module('view/weft_ways');
const { DepthOrder } = await import_page_module('view/depth_order');

const { ShaderLib } = require_package('three');
const FABRICS = Object.keys(FINISHES);
const VISIBLY_OTHER = 20; // difference of colours

const cylinder = (radius) => (u, v) => [radius * Math.sin(u), v, radius * Math.cos(u)];

test('colours of fabrics and of the palette differ from each other to the eye', () => {
  const fabrics = colors_of(FABRICS.map((fabric) => ({ fabric })));
  const palette = colors_of(PALETTE.map((color) => ({ color })));
  for (const colors of [fabrics, palette]) {
    for (const [k, color] of colors.entries()) {
      for (const other of colors.slice(0, k)) {
        const names = [color, other].map((each) => each.getHexString());
        assert.ok(difference(color, other) >= VISIBLY_OTHER, `${names}`);
      }
    }
  }
});

test('the colour of a fabric alone in its scene is its own', () => {
  for (const fabric of FABRICS) {
    const [color] = colors_of([{ fabric }]);
    assert.equal(`#${color.getHexString()}`, FINISHES[fabric].color);
  }
});

test('twelve cloths of one fabric have twelve colours, and a chosen colour stays as it is', () => {
  for (const fabric of FABRICS) {
    const looks = Array.from({ length: 12 }, (_, k) => (k === 7 ? { fabric, color: '#13579b' } : { fabric }));
    const colors = colors_of(looks);
    assert.equal(colors[7].getHexString(), '13579b');
    for (const [k, color] of colors.entries()) {
      for (const other of colors.slice(0, k)) assert.ok(difference(color, other) >= VISIBLY_OTHER);
    }
  }
});

test('white is L* 100 and black L* 0, both without hue', () => {
  const [white, black] = colors_of([{ color: '#ffffff' }, { color: '#000000' }]);
  assert.ok(lab_of(white).every((value, k) => Math.abs(value - [100, 0, 0][k]) < 0.05), `${lab_of(white)}`);
  assert.deepEqual(lab_of(black).map(Math.abs), [0, 0, 0]);
});

test('the back of a cloth is another shade unless one is chosen', () => {
  for (const fabric of FABRICS) {
    for (const color of [FINISHES[fabric].color, '#ffffff', '#101010']) {
      const look = { fabric, color };
      const [front] = colors_of([look]);
      assert.ok(difference(front, back_of(look, front)) > 5, `${fabric} ${color}`);
      assert.equal(back_of({ ...look, back: '#123456' }, front).getHexString(), '123456');
    }
  }
});

test('a tile of each weave goes on at its borders and is even on the whole', () => {
  for (const fabric of FABRICS) {
    const { texture } = weave_of(fabric);
    const { data, width } = texture.image;
    const bytes = (place) => Array.from({ length: width * 4 }, (_, k) => data[place(k >> 2) * 4 + (k & 3)]);
    const row = (y) => bytes((x) => y * width + x);
    const column = (x) => bytes((y) => y * width + x);
    const change = (one, other) =>
      one.reduce((sum, value, k) => sum + Math.abs(value - other[k]), 0) / one.length;
    for (const line of [row, column]) {
      const inside = Array.from({ length: width - 1 }, (_, k) => change(line(k), line(k + 1)));
      assert.ok(change(line(width - 1), line(0)) <= Math.max(...inside) * 1.2 + 1, fabric);
    }
    const mean = (channel) =>
      data.reduce((sum, value, k) => sum + (k % 4 === channel ? value : 0), 0) / (width * width);
    for (const slope of [0, 1]) assert.ok(Math.abs(mean(slope) - 127.5) < 2, `${fabric}: ${mean(slope)}`);
    assert.ok(Math.abs(mean(3) - 127.5) < 4, `${fabric}: ${mean(3)}`);
  }
});

test('the renderer’s shader has every part that the fabric’s replaces', () => {
  const [color] = colors_of([{}]);
  const material = fabric_material({}, color, weave_of('plain'), { size: [1, 1], round: null });
  const { vertexShader, fragmentShader } = ShaderLib.physical;
  const shader = { uniforms: {}, vertexShader, fragmentShader };
  material.onBeforeCompile(shader);
  const has = (text, part) => text.replace(/\s/g, '').includes(part.replace(/\s/g, ''));
  for (const part of ['fabric_place = uv', 'normalMatrix * weft', 'faceforward(world_normal']) {
    assert.ok(has(shader.vertexShader, part), part);
  }
  const parts = ['uniform vec3 back_color', 'weft_way - dot(weft_way', '> 1.0) discard', 'weave_seen', '? back_roughness', 'tbn * vec3(slope'];
  for (const part of [...parts, 'RE_Direct_Fabric', 'getIBLIrradiance(-', 'pow(clear']) {
    assert.ok(has(shader.fragmentShader, part), part);
  }
});

test('the finer mesh goes through each particle, and a flat cloth stays flat', () => {
  const flat = grid(7, (u, v) => [u + 0.1 * v, v, 2 * u - v]);
  const { points, normals, fine } = refined(flat, 2, 1);
  assert.deepEqual(points.subarray(0, flat.positions.length), flat.positions);
  assert.equal(fine.triangles.length, flat.triangles.length * 16);
  for (let i = 0; i < points.length; i += 3) {
    // The plane of (1, 0, 2) and (0.1, 1, -1) has the normal (2, -1.2, -1).
    const along = 2 * points[i] - 1.2 * points[i + 1] - points[i + 2];
    assert.ok(Math.abs(along) < 1e-5, `${along}`);
    assert.ok(Math.abs(Math.hypot(...normals.subarray(i, i + 3)) - 1) < 1e-5);
  }
});

test('of a cloth bent to a cylinder the finer mesh is 20 times rounder than the triangles', () => {
  const radius = 0.05;
  const coarse = grid(9, (u, v) => cylinder(radius)(u * 2, v * 0.1)); // 14 degrees a cell
  const { points, normals } = refined(coarse, 2, 1);
  const flatness = radius * (1 - Math.cos(0.125));
  for (let i = 0; i < points.length; i += 3) {
    if (points[i + 1] < 0.02 || points[i + 1] > 0.08) continue;
    const turn = Math.atan2(points[i], points[i + 2]);
    if (turn < 0.5 || turn > 1.5) continue; // at borders triangles lie on one side only
    const error = Math.abs(Math.hypot(points[i], points[i + 2]) - radius);
    assert.ok(error < flatness / 20, `${error} of ${flatness}`);
    const facing = normals[i] * Math.sin(turn) + normals[i + 2] * Math.cos(turn);
    assert.ok(Math.abs(facing) > Math.cos(0.01), `${facing}`);
  }
});

test('the weft of a bent cloth lies in it and across its bend, whichever way uv and triangles turn', () => {
  const wave = (u, v) => [u, v, 0.1 * Math.sin(4 * (u + v))];
  const slope = (u, v) => 0.4 * Math.cos(4 * (u + v));
  for (const mirrored of [false, true]) {
    const { positions, uv, triangles } = grid(33, wave);
    const given = mirrored ? uv.map((value, k) => (k % 2 ? 1 - value : value)) : uv;
    const weft = new WeftWays(triangles, given, uv.length / 2);
    let filled = 0;
    weft.update(positions, () => (filled += 1));
    assert.equal(filled, 1);
    for (let k = 0; k < uv.length / 2; k++) {
      const [u, v] = uv.subarray(k * 2, k * 2 + 2);
      if (Math.min(u, v, 1 - u, 1 - v) < 0.01) continue; // at borders triangles lie on one side only
      const way = weft.attribute.array.subarray(k * 3, k * 3 + 3);
      const true_way = [1, 0, slope(u, v)];
      const along = way.reduce((sum, value, axis) => sum + value * true_way[axis], 0);
      const cosine = along / Math.hypot(...way) / Math.hypot(...true_way);
      assert.ok(cosine > Math.cos(0.02), `${way} at ${u}, ${v}`);
    }
  }
});

test('the border of a bent cloth is a smooth curve with the corners of the cloth', () => {
  // A ring of 90 degrees: borders are arcs of radius 1 and 2, and straight lines.
  const ring = grid(7, (u, v) => [(1 + v) * Math.cos(1.57 * u), (1 + v) * Math.sin(1.57 * u), 0]);
  assert.deepEqual([...corners_of(ring.triangles, ring.uv)].sort((a, b) => a - b), [0, 6, 42, 48]);
  const { fine, points } = refined(ring, 2, 1);
  const flatness = 1 - Math.cos(1.57 / 12);
  const radius = (k) => Math.hypot(points[k * 3], points[k * 3 + 1]);
  const radii = Array.from({ length: fine.vertices }, (_, k) => radius(k));
  assert.ok(Math.max(...radii) < 2 * (1 + flatness / 8), 'nothing bulges out');
  const turn = (k) => Math.atan2(points[k * 3 + 1], points[k * 3]);
  const outer = radii.filter((value, k) => value > 1.96 && turn(k) > 0.3 && turn(k) < 1.27);
  assert.ok(outer.length > 10);
  for (const value of outer) assert.ok(value > 2 * (1 - flatness / 8), `${value}`);
});

test('the finer mesh stays within its reach of the triangles, however crumpled they are', () => {
  let state = 5;
  const random = () => (state = (state * 48271) % 2147483647) / 2147483647;
  const crumpled = grid(12, (u, v) => [u + random() * 0.1, v + random() * 0.1, random() * 0.2]);
  const reach = 0.0018;
  const { fine, points } = refined(crumpled, 2, reach);
  const flat = points.slice();
  fine.interpolate(flat, 3);
  let farthest = 0;
  for (let i = 0; i < points.length; i += 3) {
    farthest = Math.max(farthest, Math.hypot(...[0, 1, 2].map((k) => points[i + k] - flat[i + k])));
  }
  assert.ok(farthest <= reach * 1.0001, `${farthest}`);
  assert.ok(farthest > reach / 2, 'it does bend');
});

test('the two layers of a sharp fold are not drawn through each other', () => {
  const [cell, thickness, n] = [0.027, 0.004, 13];
  for (const uneven of [0, 0.3]) {
    for (const gap of [0.5 * thickness, thickness, 3 * thickness]) {
      // Columns run down one layer to the crest and up the other, which is not quite parallel to it.
      const folded = grid(n, (u, v) => {
        const [column, row] = [Math.round(u * (n - 1)) - 6, Math.round(v * (n - 1))];
        const along = cell * Math.abs(column) * (column > 0 ? 1 : 1 - 0.05 * uneven * (row % 2));
        return [along, row * cell, (Math.sign(column) * gap) / 2];
      });
      const { points } = refined(folded, 2, 0.45 * thickness, true);
      const { points: sides } = refined({ ...folded, positions: signs(n) }, 2, 0);
      for (let i = 0; i < points.length; i += 3) {
        assert.ok(points[i + 2] * sides[i + 2] > -1e-9, `${points[i + 2]} m at a gap of ${gap} m`);
      }
    }
  }
});

/** Sheets as above whose third coordinate is the layer: -1 to the crest, and 1 from there. */
const signs = (n) => grid(n, (u, v) => [u, v, Math.sign(Math.round(u * (n - 1)) - (n - 1) / 2)]).positions;

test('a round cloth of a grid is drawn as the largest ellipse within its stairs, no other cloth is', () => {
  const whole = grid(31, (u, v) => [u, v, 0]);
  const { uv } = whole;
  const cut = (inside) => {
    const kept = [];
    for (let t = 0; t < whole.triangles.length; t += 6) {
      const cell = [...whole.triangles.subarray(t, t + 6)];
      if (cell.every((k) => inside(uv[k * 2], uv[k * 2 + 1]))) kept.push(...cell);
    }
    return Uint32Array.from(kept);
  };
  const round = cut((u, v) => Math.hypot(u - 0.5, v - 0.5) <= 0.5001);
  const { center, radii } = round_of(round, uv);
  for (const axis of [0, 1]) {
    assert.ok(Math.abs(center[axis] - 0.5) < 1e-6);
    assert.ok(radii[axis] > 0.5 - 1.2 / 30 && radii[axis] < 0.5, `${radii}`);
  }
  // The circle lies within the triangles: of cells that are left out no corner and no side is in it.
  const reach = (u, v) => Math.hypot((u - 0.5) / radii[0], (v - 0.5) / radii[1]);
  const kept = new Set(round);
  for (let row = 0; row < 30; row++) {
    for (let column = 0; column < 30; column++) {
      const corners = [[0, 0], [0, 1], [1, 0], [1, 1]].map(([a, b]) => (row + a) * 31 + column + b);
      if (corners.every((k) => kept.has(k))) continue;
      const near = (low) => Math.min(Math.max(0.5, low / 30), (low + 1) / 30);
      assert.ok(reach(near(column), near(row)) > 1 - 1e-6, `${column} ${row}`);
    }
  }
  assert.equal(round_of(whole.triangles, uv), null, 'a rectangle');
  assert.equal(round_of(cut((u, v) => u + v > 0.3), uv), null, 'one without a corner');
  assert.equal(round_of(cut((u, v) => Math.abs(Math.hypot(u - 0.5, v - 0.5) - 0.35) < 0.15), uv), null, 'a ring');
});

test('a hem runs round the whole border, with the border outermost and the front shown', () => {
  const { positions, triangles } = grid(5, (u, v) => [u, v, 0]);
  const hem = new Hem(triangles, 25);
  assert.equal(hem.vertices, 16 * 8);
  const points = new Float32Array((25 + hem.vertices) * 3);
  points.set(positions);
  const normals = new Float32Array(points.length);
  smooth_normals(points, triangles, normals.subarray(0, 75));
  hem.place(points, normals, new Float32Array(25).fill(0.01));
  const point = (k) => points.subarray(k * 3, k * 3 + 3);
  let [low, high] = [0, 0];
  for (let k = 25; k < 25 + hem.vertices; k++) {
    const [x, y, z] = point(k);
    assert.ok(Math.min(x, y, 1 - x, 1 - y) > -1e-6, 'within the border');
    [low, high] = [Math.min(low, z), Math.max(high, z)];
  }
  assert.ok(Math.abs(low + 0.01) < 1e-6 && Math.abs(high - 0.01) < 1e-6);
  const sections = Array.from({ length: 16 }, (_, k) => {
    const ring = Array.from({ length: 8 }, (_, corner) => point(25 + 8 * k + corner));
    return [0, 1, 2].map((axis) => ring.reduce((sum, each) => sum + each[axis] / 8, 0));
  });
  for (let t = 0; t < hem.triangles.length; t += 3) {
    const [a, b, c] = hem.triangles.subarray(t, t + 3);
    const [p, q, r] = [a, b, c].map(point);
    const e = [0, 1, 2].map((k) => q[k] - p[k]);
    const f = [0, 1, 2].map((k) => r[k] - p[k]);
    const face = [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]];
    const along = (vector) => vector.reduce((sum, value, k) => sum + value * face[k], 0);
    const center = sections[Math.floor((a - 25) / 8)];
    assert.ok(along(p.map((value, k) => value - center[k])) < 0, 'it is seen from its other side');
    assert.ok(along([...normals.subarray(a * 3, a * 3 + 3)]) > 0, 'its normals are those of its faces');
  }
});

test('which diagonal divides a cell changes neither shape nor shading', () => {
  const one = grid(6, (u, v) => [u, v, 0.2 * u * u - 0.3 * v * v]); // bent, but not twisted
  const other = { ...one, triangles: one.triangles.slice() };
  for (let k = 0; k < one.triangles.length; k += 6) {
    const [a, b, c, d] = [...new Set(one.triangles.subarray(k, k + 6))].sort((p, q) => p - q);
    other.triangles.set([a, b, d, a, d, c], k); // the same diagonal everywhere
  }
  const [drawn, again] = [one, other].map((mesh) => {
    const { points, normals } = refined(mesh, 2, 1);
    const vertex = (k) => [...points.subarray(k * 3, k * 3 + 3), ...normals.subarray(k * 3, k * 3 + 3)];
    return Array.from({ length: points.length / 3 }, (_, k) => vertex(k));
  });
  for (const vertex of drawn) {
    const apart = (each) => Math.max(...each.map((value, k) => Math.abs(value - vertex[k])));
    assert.ok(Math.min(...again.map(apart)) < 1e-5, `${vertex}`);
  }
});

test('normals of a zigzag are evened out to two thirds of its slope, those of a bow are kept', () => {
  const slant = (place) => {
    const mesh = grid(17, place);
    const both = both_diagonals(mesh.triangles, cells_of(mesh.triangles, mesh.uv));
    const normals = new Float32Array(mesh.positions.length);
    smooth_normals(mesh.positions, both, normals);
    const before = normals.slice();
    even_normals(both, normals);
    return { before, normals };
  };
  const inside = (act) => {
    for (let row = 3; row < 14; row++) {
      for (let column = 3; column < 14; column++) act((row * 17 + column) * 3);
    }
  };
  const dents = slant((u, v) => [u, v, Math.round(u * 16) % 4 < 2 ? 0.02 : 0]);
  inside((i) => {
    assert.ok(Math.abs(dents.normals[i]) < 0.67 * Math.abs(dents.before[i]), `${i}`);
  });
  const bow = slant((u, v) => [u, v, 0.3 * u * u]);
  inside((i) => {
    for (let k = 0; k < 3; k++) assert.ok(Math.abs(bow.normals[i + k] - bow.before[i + k]) < 0.01);
  });
});

test('the size of a cloth follows from its start, also where it starts bent', () => {
  const flat = (u, v) => [1.5 * u, 0.8 * v, 0];
  const bent = (u, v) => [0.3 * Math.sin(u * 5), 0.8 * v, 0.3 * Math.cos(u * 5)];
  for (const place of [flat, bent]) {
    const { positions, uv, triangles } = grid(33, place);
    const cloth = { first_triangle: 0, triangles: triangles.length / 3 };
    const [width, height] = fabric_extent(cloth, { restPositions: positions, uv, triangles });
    assert.ok(Math.abs(width - 1.5) < 0.01 && Math.abs(height - 0.8) < 0.01, `${width} ${height}`);
  }
});

test('triangles come from far to near, and each of them once', () => {
  const { positions, triangles } = grid(20, (u, v) => [u, v, Math.sin(7 * u) * Math.cos(5 * v)]);
  const view = [1, 0, 0, 0, 0, 1, 0, 0, 0.6, 0, 0.8, 0, 0, 0, -3, 1];
  const ordered = new Uint32Array(triangles.length);
  new DepthOrder(triangles).sort({ matrixWorldInverse: { elements: view } }, positions, ordered);
  const towards = [view[2], view[6], view[10]];
  const depth = (vertex) =>
    towards.reduce((sum, part, axis) => sum + part * positions[vertex * 3 + axis], 0);
  const depths = Array.from({ length: ordered.length / 3 }, (_, t) =>
    [0, 1, 2].reduce((sum, k) => sum + depth(ordered[t * 3 + k]) / 3, 0));
  const span = Math.max(...depths) - Math.min(...depths);
  for (const [t, value] of depths.entries()) {
    if (t > 0) assert.ok(value > depths[t - 1] - span / 4000, `triangle ${t}`);
  }
  const names = (list) =>
    Array.from({ length: list.length / 3 }, (_, t) => list.slice(t * 3, t * 3 + 3).join()).sort();
  assert.deepEqual(names(ordered), names(triangles));
});

import assert from 'node:assert/strict';
import test from 'node:test';
import { import_page_module } from './support/page_module.mjs';

// Where the camera stands by itself, without a browser.

const { axes_of, part_covered, part_outside, pose_around, pose_of_view, reach_of_corners } = await import_page_module('view/framing');
const { OrbitCamera } = await import_page_module('view/camera');
const { best_side, Director, view_of_address } = await import_page_module('view/director');

const slope = Math.tan((16 * Math.PI) / 180);
const WINDOWS = [
  { slope, aspect: 1.6, above: 0.1, below: 0.15 },
  { slope, aspect: 0.5, above: 0.2, below: 0.3 },
];
const SIDES = [-2.5, -0.4, 0, 1.2].flatMap((azimuth) =>
  [0.05, 0.4, 1.2].map((elevation) => ({ azimuth, elevation })),
);

/** Points of a square sheet around a centre, along two unit vectors [m]. */
function sheet(center, u, v, size = 1, cells = 8) {
  const points = [];
  for (let i = 0; i <= cells; i++) {
    for (let j = 0; j <= cells; j++) {
      const [s, t] = [(i / cells - 0.5) * size, (j / cells - 0.5) * size];
      points.push(...[0, 1, 2].map((k) => center[k] + s * u[k] + t * v[k]));
    }
  }
  const triangles = [];
  for (let i = 0; i < cells; i++) {
    for (let j = 0; j < cells; j++) {
      const a = i * (cells + 1) + j;
      triangles.push(a, a + 1, a + cells + 1, a + 1, a + cells + 2, a + cells + 1);
    }
  }
  return { points, triangles };
}

function sphere([x, y, z], radius) {
  const points = [];
  for (let i = 0; i < 40; i++) {
    for (let j = 0; j <= 20; j++) {
      const [a, b] = [(i * Math.PI) / 20, (j * Math.PI) / 20];
      points.push(x + radius * Math.sin(b) * Math.cos(a), y + radius * Math.cos(b));
      points.push(z + radius * Math.sin(b) * Math.sin(a));
    }
  }
  return points;
}

test('the points that are framed are all in the free picture, and from no nearer they would be', () => {
  const { points } = sheet([0.3, 1, -0.2], [0.6, 0, 0.8], [0, 1, 0], 1.4);
  for (const window of WINDOWS) {
    for (const side of SIDES) {
      const pose = pose_around(points, side, window);
      const further = { ...pose, distance: pose.distance * 1.001 };
      assert.equal(part_outside(points, further, window), 0);
      const nearer = { ...pose, distance: pose.distance * 0.98 };
      assert.ok(part_outside(points, nearer, window) > 0);
    }
  }
});

/** What is free beside the points in the picture, on its four sides, as parts of its height. */
function margins(points, { target, distance, ...side }, { slope, aspect, above, below }) {
  const { right, up, back } = axes_of(side);
  const seen = { left: Infinity, right: Infinity, below: Infinity, above: Infinity };
  for (let i = 0; i < points.length; i += 3) {
    const [x, y, z] = [right, up, back].map((axis) =>
      axis.x * (points[i] - target.x) + axis.y * (points[i + 1] - target.y) + axis.z * (points[i + 2] - target.z));
    const [across, along] = [x, y].map((value) => value / slope / (distance - z) / 2);
    seen.left = Math.min(seen.left, aspect / 2 + across);
    seen.right = Math.min(seen.right, aspect / 2 - across);
    seen.below = Math.min(seen.below, 0.5 - below + along);
    seen.above = Math.min(seen.above, 0.5 - above - along);
  }
  return seen;
}

test('what is framed is in the middle of the free picture, however deep it is', () => {
  for (const axes of [[[1, 0, 0], [0, 0, 1]], [[0.6, 0, 0.8], [0, 1, 0]], [[0, 0.6, 0.8], [1, 0, 0]]]) {
    const { points } = sheet([0.3, 1, -0.2], ...axes, 1.4);
    for (const window of WINDOWS) {
      for (const side of SIDES) {
        const free = margins(points, pose_around(points, side, window), window);
        assert.ok(Math.abs(free.left - free.right) < 0.005, JSON.stringify(free));
        assert.ok(Math.abs(free.above - free.below) < 0.005, JSON.stringify(free));
      }
    }
  }
});

test('the sphere of a view just fills the free picture, to 2 %', () => {
  for (const window of WINDOWS) {
    for (const side of SIDES) {
      const view = { target: [0.2, 1.1, 0.4], direction: axes_of(side).back.toArray(), radius: 0.7 };
      const pose = pose_of_view(view, window);
      assert.ok(Math.abs(pose.azimuth - side.azimuth) < 1e-9);
      assert.equal(part_outside(sphere(view.target, 0.98 * 0.7), pose, window), 0);
      assert.ok(part_outside(sphere(view.target, 1.03 * 0.7), pose, window) > 0);
    }
  }
});

test('a hanging cloth is seen face on, whichever way it faces, and a level one from the front', () => {
  for (let turn = 0; turn < 6; turn += 0.35) {
    const u = [Math.cos(turn), 0, Math.sin(turn)];
    const { points, triangles } = sheet([0, 1, 0], u, [0, 1, 0]);
    const { back } = axes_of(best_side(points, triangles));
    const facing = Math.abs(back.x * -u[2] + back.z * u[0]);
    assert.ok(facing > 0.7, `turned by ${turn}: ${facing}`);
  }
  const { points, triangles } = sheet([0, 1, 0], [1, 0, 0], [0, 0, 1]);
  const { azimuth, elevation } = best_side(points, triangles);
  assert.ok(Math.abs(azimuth) < 0.8);
  assert.ok(elevation > 0.3 && elevation < 0.8);
});

/** A director with its camera, in front of a sheet that hangs. */
function directed() {
  const orbit = new OrbitCamera();
  orbit.resize(1600, 1000);
  const window = () => orbit.window({ above: 0.1, below: 0.1 });
  const director = new Director(orbit, window);
  const { points, triangles } = sheet([0, 1, 0], [1, 0, 0], [0, 1, 0]);
  director.begin({ cloth: points, start: points, triangles, boxes: [], ground: 0 }, null, true);
  return { orbit, director, points, window };
}

const moved = (points, by) => points.map((value, i) => value + by[i % 3]);

test('a cloth that leaves the picture is followed, and home again it is seen as at first', () => {
  const { orbit, director, points, window } = directed();
  const home = orbit.heading;
  let now = 1;
  for (const x of [0, 0.02, 0.5, 2, 9, 9.1, 3, 0]) {
    const cloth = moved(points, [x, 0.2 * x, 0]);
    for (let i = 0; i < 4; i++) director.follow(cloth, (now += 0.3));
    assert.ok(part_outside(cloth, orbit.heading, window()) <= 0.1, `${x} m away`);
    if (x === 0.02) assert.deepEqual(orbit.heading, home, 'what stays in the picture is not followed');
  }
  assert.deepEqual(orbit.heading, home);
});

test('who has moved the camera keeps it, until the scene is framed again', () => {
  const { orbit, director, points } = directed();
  orbit.orbit(0.3, 0);
  director.leave();
  const kept = orbit.heading;
  for (let now = 1; now < 4; now += 0.3) director.follow(moved(points, [5, 0, 0]), now);
  assert.deepEqual(orbit.heading, kept);
});

test('a view comes nearer to a cloth that leaves room, by no more than a part of the way', () => {
  const orbit = new OrbitCamera();
  orbit.resize(1600, 1000);
  const director = new Director(orbit, () => orbit.window({ above: 0.1, below: 0.1 }));
  const view = { target: [0, 1, 0], direction: [0, 0, 1], radius: 1 };
  const far = pose_of_view(view, orbit.window({ above: 0.1, below: 0.1 })).distance;
  for (const [size, nearer] of [[2.4, 1], [1, 0.72], [0.2, 0.72]]) {
    const { points, triangles } = sheet([0, 1, 0], [1, 0, 0], [0, 1, 0], size);
    director.begin({ cloth: points, start: points, triangles, boxes: [], ground: null }, view, true);
    const ratio = orbit.heading.distance / far;
    assert.ok(Math.abs(ratio - nearer) < 0.01, `a sheet of ${size} m: ${ratio}`);
  }
});

test('who joins while the cloth is away from the scene’s view sees the cloth, and later the view', () => {
  const orbit = new OrbitCamera();
  orbit.resize(1600, 1000);
  const window = () => orbit.window({ above: 0.1, below: 0.1 });
  const director = new Director(orbit, window);
  const view = { target: [0, 1, 0], direction: [0, 0, 1], radius: 0.5 };
  const { points, triangles } = sheet([0, 1, 0], [1, 0, 0], [0, 1, 0], 0.6);
  const begin = (cloth, seen = view) =>
    director.begin({ cloth, start: points, triangles, boxes: [], ground: null }, seen, true);
  begin(points);
  const home = orbit.heading;
  const far = moved(points, [0.9, 0.4, 0]);
  begin(far);
  assert.ok(part_outside(far, orbit.heading, window()) <= 0.1);
  director.follow(points, 1);
  assert.equal(orbit.heading.azimuth, home.azimuth);
  assert.ok(part_outside(points, orbit.heading, window()) <= 0.1, 'it follows the cloth home');
  begin(points, { ...view, radius: 0.05 });
  assert.ok(part_outside(points, orbit.heading, window()) > 0.9, 'a view of a part is kept');
});

test('no cloth of a first view is behind a panel in a corner, and is smaller only where no room is beside it', () => {
  const orbit = new OrbitCamera();
  orbit.resize(1280, 800);
  const free = () => orbit.window({ above: 0.01, below: 0.08 });
  const cases = [[0.4, 0.1, 'as before'], [1.02, 0.1, 'moved'], [1.2, 0.1, 'smaller'], [1.2, 0.12, 'smaller']];
  for (const [width, bottom, seen] of cases) {
    const corners = [{ left: 0, right: 0.1, bottom: 0.15 }, { left: 0.75, right: 1, bottom }];
    const window = () => ({ ...free(), corners });
    const { points, triangles } = sheet([0, 1, 0], [width, 0, 0], [0, 1, 0]);
    for (const view of [null, { target: [0, 1, 0], direction: [0, 0, 1], radius: 0.55 }]) {
      const begin = (free_part) => {
        const director = new Director(orbit, free_part);
        director.begin({ cloth: points, start: points, triangles, boxes: [], ground: null }, view, true);
        return orbit.heading;
      };
      const before = begin(free);
      const pose = begin(window);
      assert.equal(reach_of_corners(points, pose, window()), 0, `${width} m wide, a panel of ${bottom}`);
      assert.equal(reach_of_corners(points, before, window()) === 0, seen === 'as before');
      assert.equal(part_outside(points, pose, free()), 0);
      assert.equal(pose.distance === before.distance, seen !== 'smaller');
      assert.equal(pose.target.equals(before.target), seen === 'as before');
    }
  }
});

test('the part of a picture that cloth covers is its area there, and counts what is behind', () => {
  const orbit = new OrbitCamera();
  orbit.resize(1280, 800);
  const window = orbit.window({ above: 0, below: 0 });
  const pose = pose_of_view({ target: [0, 1, 0], direction: [0, 0, 1], radius: 0.5 }, window);
  const height = 2 * window.slope * pose.distance; // of the picture where the cloth is [m]
  const { points, triangles } = sheet([0, 1, 0], [height / 2, 0, 0], [0, height / 4, 0]);
  const covered = (indices) => part_covered(points, indices, pose, window);
  assert.ok(Math.abs(covered(triangles) - 1 / 8 / window.aspect) < 1e-6, `${covered(triangles)}`);
  assert.ok(Math.abs(covered([...triangles, ...triangles]) - 1 / 4 / window.aspect) < 1e-6);
});

test('an address may ask for a view; what is none is left', () => {
  const view = { target: [1, 2, 3], direction: [0, 0.5, 1], radius: 0.4 };
  assert.deepEqual(view_of_address('?name=A&view=1,2,3,0,0.5,1,0.4'), view);
  for (const search of ['', '?view=', '?view=1,2', '?view=1,2,3,0,0,0,1', '?view=1,2,3,a,0,1,1', '?view=1,2,3,0,0,1,-1'])
    assert.equal(view_of_address(search), null, search);
});

import { import_page_module } from './page_module.mjs';

const modules = await import_page_module(
  'hold/holding',
  'hold/key_hand',
  'view/camera',
  'view/objects',
  'view/pins',
  'view/ray',
  'view/fans',
);
export const { Holding, KeyHand, OrbitCamera } = modules;
const { Objects, Pins, Fans, cast_ray } = modules;

const WIDTH = 800;
const HEIGHT = 600;

/**
 * What hands reach for, without a browser: an upright square of cloth of 1 m and some objects, seen
 * from the front, and a client that keeps what it is asked for in `sent`.
 * @param {{colliders?: object[], grippers?: object[], cells?: number}} [options]
 */
export function made_up_room({ colliders = [], grippers = [], cells = 10 } = {}) {
  const sent = [];
  const ask = (op) => (...fields) => {
    sent.push([op, ...fields]);
    return Promise.resolve(op === 'query' ? grippers : {});
  };
  const client = { connected: true, viewer: 1, latency: NaN };
  for (const op of ['move', 'pin', 'release', 'set', 'gripper', 'query']) client[op] = ask(op);
  client.drag = (hold, options) => {
    const drag = { grab: null };
    drag.ended = new Promise((end) => (drag.lose = end));
    for (const op of ['move', 'end']) drag[op] = ask(`drag ${op}`);
    sent.push(['drag', hold, options]);
    return drag;
  };
  const orbit = new OrbitCamera();
  orbit.resize(WIDTH, HEIGHT);
  look_from_front(orbit);
  const objects = new Objects(colliders, { colliders: [] }, 0);
  const { positions, triangles } = square(cells);
  const world = {
    announcement: { colliders, cloths: [{ first_vertex: 0, vertices: positions.length / 3 }] },
    triangles,
    playback: { positions, grabs: [], poses: [], tick: 0 },
    hit({ origin, direction }) {
      const hit = cast_ray(origin, direction, positions, triangles);
      return !hit || objects.distance(origin, direction) < hit.distance ? null : hit;
    },
    hit_object({ origin, direction }) {
      const hit = objects.hit(origin, direction);
      const cloth = hit && cast_ray(origin, direction, positions, triangles);
      return cloth && cloth.distance < hit.distance ? null : hit;
    },
    hides: () => false,
    object_poses: () => objects.poses(),
  };
  const lost = [];
  const said = [];
  const reach = {
    client,
    orbit,
    fans: new Fans(),
    pins: new Pins(),
    world: () => world,
    viewer: () => undefined,
    hand_mode: () => 'live',
    moves_objects: () => false,
    is_finger: () => false,
    size: () => ({ width: WIDTH, height: HEIGHT }),
    show_fans() {},
    tell() {},
    lost: (hand, reason) => lost.push([hand, reason]),
    announce: (text) => said.push(text),
    changed() {},
  };
  return { reach, sent, lost, said, world, orbit, pins: reach.pins };
}

/** Turns a camera to look along -z at the middle of the cloth from 3 m. */
function look_from_front(orbit) {
  const camera = orbit.camera;
  camera.position.set(0, 1, 3);
  camera.lookAt(0, 1, 0);
  camera.updateMatrixWorld();
}

/** An upright square of cloth of 1 m around (0, 1, 0). */
function square(cells) {
  const side = cells + 1;
  const positions = new Float32Array(side * side * 3);
  for (let k = 0; k < side * side; k++)
    positions.set([(k % side) / cells - 0.5, 1.5 - Math.floor(k / side) / cells, 0], k * 3);
  const corners = [];
  for (let row = 0; row < cells; row++)
    for (let column = 0; column < cells; column++) {
      const a = row * side + column;
      corners.push(a, a + side, a + 1, a + 1, a + side, a + side + 1);
    }
  return { positions, triangles: Uint32Array.from(corners) };
}

/** A point of the view. */
export const point = (x, y) => ({ x, y, distanceTo: (to) => Math.hypot(to.x - x, to.y - y) });

/** The point of the view where a place [m] is seen. */
export function seen_at({ camera }, place) {
  const { x, y } = camera.position.clone().set(...place).project(camera);
  return point(x, y);
}

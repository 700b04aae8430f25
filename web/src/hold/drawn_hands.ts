import type { Grab, Vec3 } from '../../../proto/js/messages.js';
import { NO_COLOR, owner_of } from '../view/hands.js';
import type { Hand } from '../view/hands.js';
import type { ClothPoint } from '../view/fabric_circle.js';
import { point_on_triangle } from '../view/ray.js';
import type { WorldView } from '../view/world_view.js';
import type { Hold } from './hold.js';
import type { Reach } from './reach.js';

const MOST_LOOKED_AT = 8; // hands whose targets are looked for behind cloth; it takes a ray each

/**
 * The hands in the cloth as they are drawn: the own ones at their pointers, others as the playback
 * shows them.
 * @param grabs of all viewers, as the server last told
 * @param own   by the numbers of their pointers
 */
export function drawn_hands(reach: Reach, world: WorldView, grabs: Grab[], own: [number, Hold][]): Hand[] {
  const { client, orbit, viewer } = reach;
  const { positions, grabs: samples } = world.playback;
  const place = ({ triangle, barycentric }: ClothPoint) =>
    point_on_triangle(triangle, barycentric, positions, world.triangles);
  const force_of = (grab: number | null) => samples.find(({ id }) => id === grab)?.force ?? null;
  const eye = orbit.camera.position.toArray();
  const numbers = new Set(own.map(([, { grab }]) => grab));
  const others = grabs.filter(({ id, viewer }) => viewer !== client.viewer && !numbers.has(id));
  const looked_at = others.length + own.length <= MOST_LOOKED_AT;
  const marks = (held: ClothPoint, target: Vec3, grab: number | null) => ({
    held: place(held),
    target,
    hidden: looked_at && world.hides(eye, target),
    force: force_of(grab),
  });
  const self = viewer(client.viewer);
  return [
    ...others.map((grab): Hand => {
      const sample = samples.find(({ id }) => id === grab.id);
      const target = (sample?.target ?? grab.target) as Vec3;
      return { key: `${grab.id}`, ...owner_of(grab, viewer(grab.viewer)), ...marks(grab, target, grab.id) };
    }),
    ...own.map(([hand, hold]): Hand => {
      const { name = '', color = NO_COLOR } = self ?? {};
      const owner = { name, color, own: true, finger: reach.is_finger(hand) };
      return { key: `own ${hand}`, id: hold.grab ?? 0, ...owner, ...marks(hold, hold.target, hold.grab) };
    }),
  ];
}

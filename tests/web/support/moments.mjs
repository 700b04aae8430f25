import { start_server } from './server.mjs';

// The moment at which each scene shows what it is about, for pictures of it.

const USUAL_TICK = 240;
/** Where a scene shows what it is about at another time. */
const TICKS = {
  default: 600,
  'drape-sphere': 150,
  'hard-teleport': 120,
  'hard-squeeze': 120,
  'hard-stack': 180,
  'hard-point': 135,
  'hard-pinch': 110,
  'hard-mass-ratio': 130,
  'hard-warp-and-weft': 130,
  'hard-ring': 130,
  // Four seconds, as of the others.
  'hard-step-30th': 120,
  'hard-step-10th': 40,
  'hard-step-second': 4,
  'seed-fig4-no-bending': 100,
  'seed-fig4-rest-angle': 100,
  'seed-fig8-projection': 70,
  'seed-fig8-fold-map': 70,
  'seed-fig10-sharp-edge': 120,
  'seed-fig10-edge-pairs': 120,
  'seed-fig11-particle-pairs': 110,
  'seed-fig12-triangle-pairs': 110,
};
/** What a hand does in scenes that are about hands, halfway to the picture's tick. */
const HANDS = {
  wall: async (script) => drag(script, await script.pick([-0.1, 0.95, 2], [0, 0, -1]), [-0.1, 1.2, -0.4]),
  'seed-fig15-corners': (script) => script.release({ particle: 25 * 25 - 1 }),
  'seed-fig16-drag': (script) => drag(script, { particle: 12 * 25 + 12 }, [0, 1.24, 0.36]),
};
const HOLDER = 'Grace';

/** Takes hold; its name is in the picture then. */
async function drag(script, hold, target) {
  script.holds = true;
  await script.hello({ name: HOLDER });
  await script.drag(hold, { target }).started;
}

/** The tick of a scene's picture. @param scene by its name */
export const tick_of = (scene) => TICKS[scene] ?? USUAL_TICK;

/** Starts a server with a scene, paused at a tick, and gives it. */
export async function server_at(scene, tick) {
  const server = await start_server(['--paused', '--scene', scene]);
  const script = await server.script();
  const hand = HANDS[scene];
  const before = hand ? Math.floor(tick / 2) : tick;
  if (before > 0) await script.advance(before);
  await hand?.(script);
  if (tick > before) await script.advance(tick - before);
  if (!script.holds) script.close(); // or its name would be in the pictures
  return server;
}

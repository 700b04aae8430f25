// What a script may write: a strict checker finds nothing in it.

import { CommandError, WeftClient } from 'weft-client';
import type { Fan, Frame } from 'weft-client';

export async function hold(address: string): Promise<number> {
  const weft = new WeftClient(address, { name: 'script', timeout: 10_000 });
  await weft.connect();
  weft.on('frame', (frame: Frame) => console.log(frame.tick, frame.positions.length / 3));
  await weft.pause();
  const fan: Fan = { position: [0, 1, 2], direction: [0, 0, -1] };
  await weft.set({ wind: [3, 0, 0], fans: [fan], fabric: { preset: 'silk' }, over_budget: 'slow' });
  const hit = await weft.pick([0, 1, 3], [0, 0, -1]);
  if (hit) weft.drag(hit, { radius: 0.05, mode: 'sling' }).move([0, 1.5, 1]);
  const { tick, hash } = await weft.advance(3, { frames: 'last', observe: ['velocities'] });
  const energy: number = (await weft.query('energies')).kinetic;
  const values = (await weft.query('positions', { format: 'f32' })).values;
  const pulls = (await weft.query('grippers')).map((gripper) => gripper.reaction[1]);
  await weft.speed(99).catch((error: unknown) => {
    if (error instanceof CommandError) console.log(error.field, error.limit?.maximum, error.hint);
  });
  weft.close();
  return tick + hash.length + energy + values.length + pulls.length;
}

// Misspelt calls: a checker finds each line that ends in `// wrong`, and no other.

import { WeftClient } from 'weft-client';

export async function misspell(weft: WeftClient): Promise<void> {
  await weft.puase(); // wrong
  await weft.set({ wnd: [1, 0, 0] }); // wrong
  await weft.set({ over_budget: 'stop' }); // wrong
  await weft.set({ fabric: { frction: 0.2 } }); // wrong
  await weft.set({ fans: [{ position: [0, 1, 2] }] }); // wrong
  await weft.advance('3'); // wrong
  await weft.advance(3, { frames: 'first' }); // wrong
  await weft.pick([0, 1, 3]); // wrong
  await weft.query('energy'); // wrong
  console.log((await weft.query('energies')).kinetc); // wrong
  console.log((await weft.query('positions', { format: 'f64' })).length); // wrong
  console.log((await weft.hash()).hsh); // wrong
  console.log((await weft.pause()).pausd); // wrong
  weft.drag({ particle: 7 }, { raduis: 0.05 }); // wrong
  weft.drag({ particle: 7 }).mvoe([0, 1, 0]); // wrong
  weft.on('frame', (frame) => console.log(frame.tik)); // wrong
  weft.on('fram', () => {}); // wrong
}

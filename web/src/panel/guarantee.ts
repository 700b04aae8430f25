import type { Crossings, Guarantee } from '../../../proto/js/messages.js';

/** The server's present promise that nothing passes through, in plain words. */
export function guarantee_text({ state, covers }: Guarantee): string {
  switch (state) {
    case 'held':
      return covers.includes('cloth')
        ? 'Cloth passes through nothing'
        : 'Cloth passes through no object';
    case 'bad_start':
      return 'It began tangled, and comes free';
    case 'void':
      return 'Something was forced through the cloth';
    case 'none':
      return 'Nothing keeps this cloth from passing through';
  }
}

/** Why the promise does not hold, exactly; empty if it does. */
export function reasons_text({ pairs, reasons }: Guarantee): string {
  if (reasons.length === 0) return '';
  const what = pairs > 0 ? ` for ${pairs} ${pairs === 1 ? 'pair' : 'pairs'}` : '';
  return `Not promised${what}: ${reasons.join('; ')}`;
}

/** The last count, with the smallest gap in millimetres. */
export function crossings_text({ count, smallest_gap }: Crossings): string {
  const crossings = `${count} ${count === 1 ? 'crossing' : 'crossings'}`;
  if (smallest_gap === null) return `${crossings}, nothing near`;
  const size = Math.abs(smallest_gap) * 1000;
  const text = `${size.toFixed(size < 1 ? 2 : 1)} mm`;
  return smallest_gap < 0
    ? `${crossings}, up to ${text} inside an object`
    : `${crossings}, smallest gap ${text}`;
}

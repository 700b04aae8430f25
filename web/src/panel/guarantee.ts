import type { Crossings, Guarantee } from '../../../proto/js/messages.js';

/** The server's present promise that nothing passes through. */
export function guarantee_text({ state, covers, pairs, reasons }: Guarantee): string {
  const why = reasons.join('; ');
  switch (state) {
    case 'held':
      return covers.includes('cloth') ? 'Nothing passes through' : 'Nothing passes through objects';
    case 'bad_start':
      return `Not promised for ${pairs} ${pairs === 1 ? 'pair' : 'pairs'}: ${why}`;
    case 'void':
      return `No longer promised: ${why}`;
    case 'none':
      return 'This contact promises nothing';
  }
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

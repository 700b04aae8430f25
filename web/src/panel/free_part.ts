import { element } from './element.js';

const MARGIN = 12; // between panels and what is framed [pixels]
const MOST_ABOVE = 0.25;
const MOST_BELOW = 0.4;

/** Fractions of the view's height [pixels] that panels cover, above and below what they leave free. */
export function covered(height: number): { above: number; below: number } {
  const corners = [...document.querySelectorAll('.corner')];
  const lowest = Math.max(0, ...corners.map((corner) => corner.getBoundingClientRect().bottom));
  const toolbar = element('toolbar').getBoundingClientRect();
  const shown = toolbar.height > 0;
  return {
    above: lowest > 0 ? Math.min(MOST_ABOVE, (lowest + MARGIN) / height) : 0,
    below: shown ? Math.min(MOST_BELOW, (height - toolbar.top) / height) : 0,
  };
}

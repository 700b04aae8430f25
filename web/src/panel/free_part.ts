import type { Window } from '../view/framing.js';
import { element } from './element.js';

const MARGIN = 12; // between panels and what is framed [pixels]
const MIDDLE = 0.44; // of the width, where what is framed is; a corner beside it may cover nothing
const MOST_ABOVE = 0.25;
const MOST_BELOW = 0.4;

/**
 * Fractions of the view's height that panels cover, above and below what they leave free, and the panels in
 * corners beside the middle; sizes [pixels].
 */
export function covered(width: number, height: number): Pick<Window, 'above' | 'below' | 'corners'> {
  const [left, right] = [(width * (1 - MIDDLE)) / 2, (width * (1 + MIDDLE)) / 2];
  const corners = [...document.querySelectorAll('.corner')].map((corner) => corner.getBoundingClientRect());
  const is_between = (corner: DOMRect) => corner.right > left && corner.left < right;
  const between = corners.filter(is_between);
  const beside = corners.filter((corner) => corner.width > 0 && !is_between(corner));
  const lowest = Math.max(0, ...between.map(({ bottom }) => bottom));
  const toolbar = element('toolbar').getBoundingClientRect();
  const shown = toolbar.height > 0;
  return {
    above: Math.min(MOST_ABOVE, (lowest + MARGIN) / height),
    below: shown ? Math.min(MOST_BELOW, (height - toolbar.top) / height) : 0,
    corners: beside.map((corner) => ({
      left: (corner.left - MARGIN) / width,
      right: (corner.right + MARGIN) / width,
      bottom: (corner.bottom + MARGIN) / height,
    })),
  };
}

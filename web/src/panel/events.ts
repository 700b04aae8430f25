import type { Notice } from '../../../proto/js/messages.js';
import { named } from '../view/words.js';

/** What a sentence may name. */
export interface Present {
  /** This viewer's number. */
  own: number;
  /** The title of the scene that is shown. */
  scene: string;
  /** The name of a viewer who is or was here. */
  name(viewer: number): string | undefined;
}

// The measurements show these all the time.
const SHOWN_ELSEWHERE = new Set(['frames_dropped', 'slow_motion']);
// A notice tells of these, with the reason.
const LOSSES_WITH_NOTICE = new Set(['released by the server', 'lease expired']);

/** A notice as a sentence; null if there is nothing to say. */
export function notice_text(notice: Notice, present: Present): string | null {
  const { level, code, message, viewer } = notice;
  switch (code) {
    case 'reset':
      return `${who(viewer, present)} reset the scene`;
    case 'loaded':
      return `${who(viewer, present)} chose the scene “${present.scene}”`;
    case 'lead':
      return viewer === present.own ? null : `${who(viewer, present)} shows its view`;
    case 'policy':
      return message[0].toUpperCase() + message.slice(1);
    case 'lease_expired':
      return viewer === present.own
        ? 'Your hand let go, because nothing came from this page for a while'
        : null;
  }
  return level === 'info' || SHOWN_ELSEWHERE.has(code) ? null : message;
}

/** Why the own hand let go by itself, as a sentence; null if a notice tells. */
export function loss_text(reason: string): string | null {
  return LOSSES_WITH_NOTICE.has(reason) ? null : `The cloth could not be held: ${reason}`;
}

function who(viewer: number | undefined, { own, name }: Present): string {
  if (viewer === own) return 'You';
  const known = viewer !== undefined && name(viewer);
  return known ? named(known[0].toUpperCase() + known.slice(1)) : 'Somebody';
}

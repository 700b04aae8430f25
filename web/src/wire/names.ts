const SUBSTITUTE = '\ufffd';

// Joiners between letters, which join or part these, and all of an emoji.
const KEPT =
  /(?!\p{DI})[\p{L}\p{M}][\u200c\u200d](?=(?!\p{DI})[\p{L}\p{M}])|\p{ExtPict}\p{EMod}?\ufe0f?(\u200d(?=\p{ExtPict}))?/u;

// What is not seen, or turns the order of letters: control and format characters, fillers and the like.
const UNSEEN = /[\p{Cc}\p{Cf}\p{Zl}\p{Zp}\p{DI}\u2800]/u;
const EITHER = new RegExp(`(${KEPT.source})|${UNSEEN.source}`, 'gu');

/** Puts a substitute in place of each character that is not seen. */
export function without_unseen(text: string, substitute: string): string {
  return text.replace(EITHER, (_, kept?: string) => kept ?? substitute);
}

/** A viewer's name as the page shows it; one in which nothing is seen is that of a viewer without a name. */
export function shown_name({ id, name }: { id: number; name: string }): string {
  const seen = without_unseen(name, SUBSTITUTE).trim();
  return /[^\s\p{M}\ufffd]/u.test(seen) ? seen : `viewer ${id}`;
}

// A name within a sentence stands between an isolate and its end, characters that no shown name has.
const MARKS = /[\u2068\u2069]/;

/** A name as part of a sentence. */
export function named(name: string): string {
  return `\u2068${name}\u2069`;
}

/** Writes a sentence. Each name in it is an element of its own: it turns no other letters, and is cut if it is long. */
export function write_words(target: HTMLElement, words: string): void {
  const parts = words.split(MARKS).map((part, k) => (k % 2 ? name_element(part) : part));
  target.replaceChildren(...parts);
}

/** A viewer's name. */
export function name_element(name: string): HTMLElement {
  const made = document.createElement('bdi');
  made.className = 'viewer-name';
  made.textContent = made.title = name;
  return made;
}

// What cannot have the focus: it is disabled, or not to be seen.
const UNUSABLE = ':disabled, [hidden], [hidden] *, dialog:not([open]) *';

/**
 * Keeps the focus from being dropped where what has it is hidden, disabled or gone: the view gets it, or the first
 * button of an open dialog. If it can be used again before another key or pointer is pressed, as after the server was
 * away for a while, it has the focus back.
 */
export function keep_focus(view: HTMLElement): void {
  let last: HTMLElement | null = null; // that had the focus
  let lost: HTMLElement | null = null; // that is to have it back
  const usable = (one: HTMLElement) => one.isConnected && !one.matches(UNUSABLE);
  const focus = (one: HTMLElement | null) => one?.focus({ preventScroll: true });
  window.addEventListener('focusin', ({ target }) => (last = target as HTMLElement));
  for (const name of ['keydown', 'pointerdown']) window.addEventListener(name, () => (lost = null), true);
  new MutationObserver(() => {
    const now = document.activeElement;
    if (lost && usable(lost)) {
      if (now === last) focus(lost);
      lost = null;
    } else if (last && !usable(last) && (now === last || now === document.body)) {
      lost ??= last;
      focus(document.querySelector<HTMLElement>('dialog[open] button') ?? view);
    }
  }).observe(document.body, { subtree: true, childList: true, attributeFilter: ['hidden', 'disabled', 'open'] });
}

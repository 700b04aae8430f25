/**
 * Marks the view while it has the focus by the Tab key. After a click it has no frame, whichever
 * key is pressed then; `:focus-visible` would give it one.
 */
export function frame_focus(view: HTMLElement): void {
  let tabbed = false;
  const unframe = () => delete view.dataset.tabbed;
  const listen = (name: 'keydown' | 'pointerdown', handle: (event: Event) => void) =>
    window.addEventListener(name, handle, { capture: true });
  listen('keydown', (event) => (tabbed = (event as KeyboardEvent).key === 'Tab'));
  listen('pointerdown', () => {
    tabbed = false;
    unframe();
  });
  view.addEventListener('focus', () => tabbed && (view.dataset.tabbed = ''));
  view.addEventListener('blur', unframe);
}

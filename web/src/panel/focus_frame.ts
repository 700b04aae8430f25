/**
 * Marks the view while it has the focus, if the Tab key was pressed since the last click. Other keys give it no frame,
 * as `:focus-visible` would, and take none away.
 */
export function frame_focus(view: HTMLElement): void {
  let tabbed = false; // since the last click
  const unframe = () => delete view.dataset.tabbed;
  const listen = (name: 'keydown' | 'pointerdown', handle: (event: Event) => void) =>
    window.addEventListener(name, handle, { capture: true });
  listen('keydown', (event) => (tabbed ||= (event as KeyboardEvent).key === 'Tab'));
  listen('pointerdown', () => {
    tabbed = false;
    unframe();
  });
  view.addEventListener('focus', () => tabbed && (view.dataset.tabbed = ''));
  view.addEventListener('blur', unframe);
}

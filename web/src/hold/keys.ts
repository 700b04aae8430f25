const ORBIT_STEP = 0.12; // [rad]
const ZOOM_STEP = 1.12;

export interface KeyActions {
  toggle_pin(): void;
  toggle_pause(): void;
  step(): void;
  reset(): void;
  toggle_fan(): void;
  toggle_boxes(): void;
  toggle_sling(): void;
  frame(): void;
  scenes(): void;
  help(): void;
  figures(): void;
  orbit(azimuth: number, elevation: number): void;
  zoom(factor: number): void;
}

/** Keys of the whole page, except those that a focused control uses itself. */
export function listen_to_keys(actions: KeyActions): void {
  const anywhere: Record<string, () => void> = {
    m: () => actions.toggle_pin(),
    '.': () => actions.step(),
    r: () => actions.reset(),
    w: () => actions.toggle_fan(),
    b: () => actions.toggle_boxes(),
    s: () => actions.toggle_sling(),
    f: () => actions.frame(),
    l: () => actions.scenes(),
    i: () => actions.figures(),
    '?': () => actions.help(),
  };
  const outside_controls: Record<string, () => void> = {
    ' ': () => actions.toggle_pause(),
    ArrowLeft: () => actions.orbit(-ORBIT_STEP, 0),
    ArrowRight: () => actions.orbit(ORBIT_STEP, 0),
    ArrowUp: () => actions.orbit(0, ORBIT_STEP),
    ArrowDown: () => actions.orbit(0, -ORBIT_STEP),
    '+': () => actions.zoom(1 / ZOOM_STEP),
    '-': () => actions.zoom(ZOOM_STEP),
  };
  window.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const element = event.target instanceof Element ? event.target : null;
    // A dialog takes no keys but its own; a list uses letters itself.
    if (element?.closest('dialog, select')) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const free = !element?.closest('button, input');
    const action = anywhere[key] ?? (free ? outside_controls[key] : undefined);
    if (!action) return;
    event.preventDefault();
    const repeats = key.startsWith('Arrow') || key === '.' || key === '+' || key === '-';
    if (!event.repeat || repeats) action();
  });
}

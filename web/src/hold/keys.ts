const ORBIT_STEP = 0.12; // [rad]
const ZOOM_STEP = 1.12;
const RADIUS_STEP = 1.25;

export interface KeyActions {
  toggle_pin(): void;
  toggle_pause(): void;
  step(): void;
  reset(): void;
  toggle_fan(): void;
  toggle_boxes(): void;
  toggle_sling(): void;
  toggle_objects(): void;
  /** @param factor of the radius that a hand holds */
  widen(factor: number): void;
  /** Closes or opens grippers. */
  squeeze(): void;
  frame(): void;
  scenes(): void;
  /** The list of rooms. */
  rooms(): void;
  /** A copy of this room, for this viewer to try. */
  copy(): void;
  help(): void;
  figures(): void;
  /** Puts the keyboard's cursor on the cloth, or takes it away. */
  toggle_cursor(): void;
  /** Moves what the keyboard holds or points with. @returns whether there is anything */
  arrow(x: number, y: number, in_depth: boolean): boolean;
  /** @returns whether there was anything to take or to let go */
  enter(): boolean;
  /** @returns whether there was anything to end */
  escape(): boolean;
  hide_panels(): void;
  /** @param steps 1 doubles the speed of time, -1 halves it */
  change_speed(steps: number): void;
  orbit(azimuth: number, elevation: number): void;
  zoom(factor: number): void;
}

/** @returns false if the key did nothing and is left to the browser */
type Action = (event: KeyboardEvent) => boolean | void;

/** Keys of the whole page, except those that a focused control uses itself. */
export function listen_to_keys(actions: KeyActions): void {
  const arrow = (x: number, y: number) => (event: KeyboardEvent) => {
    if (!actions.arrow(x, y, event.shiftKey)) actions.orbit(x * ORBIT_STEP, y * ORBIT_STEP);
  };
  const anywhere: Record<string, Action> = {
    m: () => actions.toggle_pin(),
    '.': () => actions.step(),
    r: () => actions.reset(),
    w: () => actions.toggle_fan(),
    b: () => actions.toggle_boxes(),
    c: () => actions.toggle_cursor(),
    s: () => actions.toggle_sling(),
    o: () => actions.toggle_objects(),
    g: () => actions.squeeze(),
    '[': () => actions.widen(1 / RADIUS_STEP),
    ']': () => actions.widen(RADIUS_STEP),
    f: () => actions.frame(),
    l: () => actions.scenes(),
    a: () => actions.rooms(),
    t: () => actions.copy(),
    i: () => actions.figures(),
    h: () => actions.hide_panels(),
    '<': () => actions.change_speed(-1),
    '>': () => actions.change_speed(1),
    '?': () => actions.help(),
  };
  const outside_controls: Record<string, Action> = {
    ' ': () => actions.toggle_pause(),
    ArrowLeft: arrow(-1, 0),
    ArrowRight: arrow(1, 0),
    ArrowUp: arrow(0, 1),
    ArrowDown: arrow(0, -1),
    Enter: () => actions.enter(),
    Escape: () => actions.escape(),
    '+': () => actions.zoom(1 / ZOOM_STEP),
    '-': () => actions.zoom(ZOOM_STEP),
  };
  let pointed = false; // a pointer, and not the keyboard, was the last to choose a control
  window.addEventListener('pointerdown', () => (pointed = true), true);
  window.addEventListener('keydown', (event) => {
    if (event.key === 'Tab') pointed = false;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const element = event.target instanceof Element ? event.target : null;
    // A dialog takes no keys but its own; a list uses letters itself.
    if (element?.closest('dialog, select')) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const control = element?.closest<HTMLElement>('button, input');
    const left = pointed && control?.matches('button'); // else the button would be pressed again
    const free = !control || left || (key === ' ' && control.matches('[type="range"]'));
    const action = anywhere[key] ?? (free ? outside_controls[key] : undefined);
    if (!action) return;
    if (left) control?.blur();
    const repeats = key.startsWith('Arrow') || '.+-[]'.includes(key);
    if ((!event.repeat || repeats) && action(event) === false) return;
    event.preventDefault();
  });
}

const MOST_PIXELS_PER_UNIT = 2;
const LEAST_PIXELS_PER_UNIT = 0.5;
const STILL_SUPERSAMPLING = 1.5; // without multisampling
const SLOW_PICTURE = 0.045; // that makes the following ones coarser [s]
const JUDGED_PICTURES = 5;

/** How finely the picture is drawn: as finely as possible at rest, else as the machine can. */
export class Quality {
  /** Whether the picture was declared still. */
  still = false;
  private coarseness = 1;
  private slow_pictures = 0;

  /** @param software whether the processor draws, without multisampling */
  constructor(private software: boolean) {}

  /** Pixels of the canvas for each unit of the page's layout. */
  get pixel_ratio(): number {
    const finest = Math.min(MOST_PIXELS_PER_UNIT, window.devicePixelRatio);
    if (this.still) return this.software ? finest * STILL_SUPERSAMPLING : finest;
    return Math.min(finest, Math.max(LEAST_PIXELS_PER_UNIT, finest / this.coarseness));
  }

  /** Tells whether the picture is still, which leaves time for a fine one. */
  set_still(still: boolean): void {
    if (this.still !== still) this.slow_pictures = 0;
    this.still = still;
  }

  /**
   * Draws coarser if a machine cannot keep up, because a lagging hand is worse than a soft edge.
   * @param interval between two consecutive pictures [s]
   */
  judge(interval: number): void {
    if (this.still) return;
    this.slow_pictures = interval > SLOW_PICTURE ? this.slow_pictures + 1 : 0;
    if (this.slow_pictures < JUDGED_PICTURES || this.pixel_ratio <= LEAST_PIXELS_PER_UNIT) return;
    this.coarseness *= Math.SQRT2;
    this.slow_pictures = 0;
  }
}

/** Whether the processor renders in place of a graphics card, as far as the browser tells. */
export function draws_in_software(): boolean {
  const context = document.createElement('canvas').getContext('webgl2');
  if (!context) return true;
  const names = context.getExtension('WEBGL_debug_renderer_info');
  const name = context.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : context.RENDERER);
  context.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(String(name));
}

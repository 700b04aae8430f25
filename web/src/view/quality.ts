const MOST_PIXELS_PER_UNIT = 2;
const LEAST_PIXELS_PER_UNIT = 0.5;
const SLOW_PICTURE = 0.045; // that makes the following ones coarser [s]
const JUDGED_PICTURES = 5; // slow in a row
const VERY_SLOW_PICTURE = 3 * SLOW_PICTURE; // counts twice, so that three are enough, but not one or two [s]
// A step finer has twice the pixels, so a picture of less than half the limit has room for it.
const ROOMY_PICTURE = SLOW_PICTURE / 2; // [s]
const ROOMY_WAIT = 0.4; // of roomy pictures before the first try of a finer one [s]
const TIGHT_WAIT = 6; // of other pictures that are not slow [s]
const LONGEST_WAIT = 60; // after many tries that failed [s]
const TRIAL = 2; // a finer picture that is not slow for so long has come to stay [s]

/**
 * How finely the picture is drawn: as finely as possible at rest, else as the machine can. Slow
 * pictures make the next ones coarser at once; quick ones make them finer step by step. A try that
 * fails doubles the wait for the next, so that a machine at its limit does not waver.
 */
export class Quality {
  /** Whether the picture was declared still. */
  still = false;
  private level = 0; // steps down from the finest; each halves the number of pixels
  private slow_pictures = 0; // in a row
  private quick_time = 0; // since the last slow picture or change of level [s]
  private roomy_time = 0; // its last part in which all pictures were roomy [s]
  private trial = Infinity; // time since a step finer that is not decided yet [s]
  private tried_roomy = false;
  private roomy_wait = ROOMY_WAIT;
  private tight_wait = TIGHT_WAIT;

  /** @param density physical pixels for each unit of the page's layout */
  constructor(private density: () => number) {}

  /** Pixels of the canvas for each unit of the page's layout. */
  get pixel_ratio(): number {
    const finest = Math.min(MOST_PIXELS_PER_UNIT, this.density());
    if (this.still) return finest;
    return Math.min(finest, Math.max(LEAST_PIXELS_PER_UNIT, finest / Math.SQRT2 ** this.level));
  }

  /** Tells whether the picture is still, which leaves time for a fine one. */
  set_still(still: boolean): void {
    if (this.still !== still) this.slow_pictures = 0;
    this.still = still;
  }

  /**
   * Draws coarser if a machine cannot keep up, because a lagging hand is worse than a soft edge, and
   * finer again when it can.
   * @param interval between two consecutive pictures [s]
   */
  judge(interval: number): void {
    if (this.still) return;
    if (interval > SLOW_PICTURE) this.judge_slow(interval);
    else this.judge_quick(interval);
  }

  private judge_slow(interval: number): void {
    this.quick_time = this.roomy_time = 0;
    this.slow_pictures += interval > VERY_SLOW_PICTURE ? 2 : 1;
    if (this.slow_pictures < JUDGED_PICTURES || this.pixel_ratio <= LEAST_PIXELS_PER_UNIT) return;
    const failed = this.trial < TRIAL;
    if (failed && this.tried_roomy) this.roomy_wait = Math.min(LONGEST_WAIT, 2 * this.roomy_wait);
    if (failed) this.tight_wait = Math.min(LONGEST_WAIT, 2 * this.tight_wait);
    this.change_level(this.steps_from(interval));
    this.trial = Infinity;
  }

  /** By as many steps as would do if all of a picture's time were that of its pixels, at least one. */
  private steps_from(interval: number): number {
    const to_least = Math.ceil(2 * Math.log2(this.pixel_ratio / LEAST_PIXELS_PER_UNIT));
    return Math.max(1, Math.min(to_least, Math.floor(Math.log2(interval / SLOW_PICTURE))));
  }

  private judge_quick(interval: number): void {
    this.slow_pictures = 0;
    this.quick_time += interval;
    this.roomy_time = interval < ROOMY_PICTURE ? this.roomy_time + interval : 0;
    this.trial += interval;
    if (this.trial >= TRIAL && Number.isFinite(this.trial)) this.settle();
    const roomy = this.roomy_time >= this.roomy_wait;
    if (this.level === 0 || !(roomy || this.quick_time >= this.tight_wait)) return;
    this.tried_roomy = roomy;
    this.change_level(-1);
    this.trial = 0;
  }

  /** The last try has succeeded; what failed before counts no longer. */
  private settle(): void {
    this.trial = Infinity;
    this.roomy_wait = ROOMY_WAIT;
    this.tight_wait = TIGHT_WAIT;
  }

  private change_level(step: number): void {
    this.level += step;
    this.slow_pictures = this.quick_time = this.roomy_time = 0;
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

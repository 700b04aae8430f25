import { NeutralToneMapping, PCFShadowMap, Scene, Vector2, WebGLRenderer } from 'three';
import type { Box3, PerspectiveCamera, WebGLRenderTarget } from 'three';
import { Backdrop } from './backdrop.js';
import { Exposure } from './exposure.js';
import { Floor } from './floor.js';
import { Light, REFLECTED, reflections } from './light.js';
import type { Lighting } from './light.js';
import { PALETTES } from './palette.js';
import type { Theme } from './palette.js';
import { draws_in_software, Quality } from './quality.js';
import { sample_of } from './samples.js';
import { soften_shadows } from './soft_shadow.js';

const LINKING_LOOK = 10; // between looks at programs that are being linked [ms]
const EXPOSURES = { hardware: 24, software: 10 }; // whose mean is the finest picture

/** What the stage tells. */
interface Heard {
  /** Whether the graphics context is away; it comes back by itself, or never. */
  lost: (away: boolean) => void;
  /** The next picture would be another one. */
  changed: () => void;
}

/**
 * A studio: light, a floor with a grid that fades into the distance, and the renderer. The first
 * pictures are simply lit; `complete` adds what takes time to prepare.
 */
export class Stage {
  readonly scene = new Scene();
  readonly renderer: WebGLRenderer;
  readonly quality = new Quality(() => window.devicePixelRatio);
  private drawn_in: 'software' | 'hardware' = draws_in_software() ? 'software' : 'hardware';
  private light_ = new Light();
  private lighting: Lighting = 'simple';
  private floor = new Floor(PALETTES.light);
  private backdrop = new Backdrop(PALETTES.light);
  private exposure: Exposure;
  private exposed = 0; // pictures in the mean that is shown
  private completing: Promise<void> | null = null;
  private camera: PerspectiveCamera | null = null; // of the pictures; none before the first one
  /** Whether reflections and shadows are there. */
  lit = false;
  private room: WebGLRenderTarget | null = null; // that surfaces reflect

  /** @param simple whether its first, simple light is to stay */
  constructor(
    private canvas: HTMLCanvasElement,
    readonly simple: boolean,
    private heard: Heard,
  ) {
    soften_shadows();
    // Multisampling is too expensive for software renderers, and leaves cracks there.
    this.renderer = new WebGLRenderer({ canvas, antialias: this.drawn_in === 'hardware' });
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.exposure = new Exposure(this.renderer);
    this.scene.add(this.backdrop.mesh, this.light_.group, this.floor.mesh);
    this.floor.mesh.visible = false;
    this.scene.environmentIntensity = REFLECTED;
    canvas.addEventListener('webglcontextlost', () => heard.lost(true));
    // The renderer listens too, and first; what it loads from arrays it loads anew by itself.
    canvas.addEventListener('webglcontextrestored', () => {
      if (this.room) this.make_room();
      if (this.lighting === 'whole') this.scene.environment = this.room?.texture ?? null;
      if (this.camera) this.renderer.compile(this.scene, this.camera);
      heard.lost(false);
    });
  }

  set theme(theme: Theme) {
    this.floor.paint(PALETTES[theme]);
    this.backdrop.paint(PALETTES[theme]);
    this.heard.changed();
  }

  /** Places the floor at a height [m], or removes it. */
  set_floor(height: number | null): void {
    this.floor.mesh.visible = height !== null;
    if (height !== null) this.raise_floor(height);
  }

  /** Raises or lowers the floor, if there is one. */
  raise_floor(height: number): void {
    this.floor.mesh.position.y = height;
  }

  /** Fits the lights' shadows to the box that can move [m]; a smaller box gives finer shadows. */
  light(box: Box3): void {
    this.light_.fit(box);
  }

  /** Each of the renderer's two calls makes the canvas anew, so that which changes nothing is left out. */
  resize(width: number, height: number): void {
    const { renderer, quality } = this;
    if (renderer.getPixelRatio() !== quality.pixel_ratio) renderer.setPixelRatio(quality.pixel_ratio);
    if (!renderer.getSize(new Vector2()).equals(new Vector2(width, height))) renderer.setSize(width, height, false);
  }

  /**
   * Chooses how finely the next pictures are drawn.
   * @param still    whether nothing changes, which leaves time for a fine picture
   * @param interval between this picture and the one just before it [s]; none if it is the first
   * @returns whether the view must be resized
   */
  refine(still: boolean, interval: number | null): boolean {
    this.quality.set_still(still);
    if (interval !== null) this.quality.judge(interval);
    return this.renderer.getPixelRatio() !== this.quality.pixel_ratio;
  }

  /** Whether pictures of what moves are drafts, quickly drawn, because the processor draws them. */
  get drafts(): boolean {
    return this.drawn_in === 'software' && !this.simple;
  }

  /** Draws the present picture. */
  draw(camera: PerspectiveCamera): void {
    this.exposed = 0;
    if (this.lit) this.light_up(this.drafts ? 'quick' : 'whole');
    this.renderer.render(this.scene, camera);
    if (this.lit && this.drawn_in === 'software') this.exposure.smooth();
  }

  /** Whether the picture is as fine as it gets. */
  get fine(): boolean {
    return this.lights_stay && (this.exposed >= EXPOSURES[this.drawn_in] || !this.exposure.averages);
  }

  private get lights_stay(): boolean {
    return this.lit || this.simple;
  }

  /** Whether a picture that does not change can be made finer. */
  get exposes(): boolean {
    return this.lights_stay && !this.fine;
  }

  /** Makes a picture that does not change finer by one more exposure. */
  expose(camera: PerspectiveCamera): void {
    if (!this.exposes) return;
    const { width, height } = this.canvas;
    if (this.lit) this.light_up('whole');
    const sample = this.exposed > 0 ? sample_of(this.exposed - 1) : null;
    if (sample) camera.setViewOffset(width, height, ...sample.pixel, width, height);
    this.floor.key_blur = this.light_.show(sample, EXPOSURES[this.drawn_in]);
    this.renderer.render(this.scene, camera);
    this.exposure.add(this.exposed);
    this.exposed += 1;
    camera.clearViewOffset();
    this.floor.key_blur = this.light_.show(null);
  }

  /**
   * Prepares programs, and unless the light stays simple reflections and shadows, beside the
   * pictures that are drawn meanwhile, and adds them. Call it when a first picture is on the screen.
   */
  complete(camera: PerspectiveCamera): Promise<void> {
    this.camera = camera;
    this.completing ??= this.simple ? this.prepare_simple(camera) : this.prepare(camera);
    return this.completing;
  }

  /** Makes the programs of what is not seen yet, such as marks of hands. */
  private async prepare_simple(camera: PerspectiveCamera): Promise<void> {
    await next_task();
    this.renderer.compile(this.scene, camera);
  }

  private async prepare(camera: PerspectiveCamera): Promise<void> {
    await next_task();
    this.make_room();
    await next_task();
    // Programs depend on the lights; they are linked while the simple ones go on drawing.
    for (const lighting of this.drafts ? (['quick', 'whole'] as const) : (['whole'] as const)) {
      this.light_up(lighting);
      this.renderer.compile(this.scene, camera);
    }
    this.light_up('simple');
    await this.linked();
    this.lit = true;
    this.heard.changed();
  }

  /**
   * Waits until all programs are linked. The renderer's own wait for this, `compileAsync`, fails if
   * a material is disposed of meanwhile, as by another scene.
   */
  private async linked(): Promise<void> {
    type Linking = { isReady(): boolean };
    const programs = () => (this.renderer.info.programs ?? []) as unknown as Linking[];
    do await new Promise((done) => setTimeout(done, LINKING_LOOK));
    while (programs().some((program) => !program.isReady()));
  }

  private make_room(): void {
    this.room?.dispose();
    this.room = reflections(this.renderer);
  }

  private light_up(lighting: Lighting): void {
    if (this.lighting === lighting) return;
    this.lighting = lighting;
    this.scene.environment = lighting === 'whole' && this.room ? this.room.texture : null;
    this.light_.lighting = lighting;
    this.renderer.shadowMap.enabled = lighting !== 'simple';
  }
}

/** Lets events that wait and a picture come before what follows. */
const next_task = () => new Promise((done) => setTimeout(done));

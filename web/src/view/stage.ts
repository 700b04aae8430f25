import {
  DirectionalLight,
  HemisphereLight,
  NeutralToneMapping,
  PCFShadowMap,
  Scene,
  Vector3,
  WebGLRenderer,
} from 'three';
import type { Box3 } from 'three';
import { dome } from './backdrop.js';
import { floor } from './floor.js';
import { soft_boxes } from './light.js';
import { draws_in_software, Quality } from './quality.js';

/** A studio: light, a floor with a grid that fades into the distance, and the renderer. */
export class Stage {
  readonly scene = new Scene();
  readonly renderer: WebGLRenderer;
  readonly quality: Quality;
  private sun = new DirectionalLight('#fff4e6', 2.4);

  /** @param lost tells whether the graphics context is away; it comes back by itself, or never */
  constructor(canvas: HTMLCanvasElement, lost: (away: boolean) => void) {
    const software = draws_in_software();
    this.quality = new Quality(software, () => window.devicePixelRatio);
    // Multisampling is too expensive for software renderers, and leaves cracks there.
    this.renderer = new WebGLRenderer({ canvas, antialias: !software });
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.scene.environment = soft_boxes(this.renderer);
    canvas.addEventListener('webglcontextlost', () => lost(true));
    // The renderer listens too, and first; what it loads from arrays it loads anew by itself.
    canvas.addEventListener('webglcontextrestored', () => {
      this.scene.environment = soft_boxes(this.renderer);
      lost(false);
    });
    this.scene.environmentIntensity = 0.7;
    this.scene.add(dome(), this.sun, this.sun.target);
    this.scene.add(new HemisphereLight('#ffffff', '#cfc4b4', 0.45));
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(1024, 1024);
    this.sun.shadow.radius = 3.5;
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.012;
  }

  /** Places the floor at a height, or removes it. */
  set_floor(height: number | null): void {
    this.scene.getObjectByName('floor')?.removeFromParent();
    if (height !== null) this.scene.add(floor(height));
  }

  /** Raises or lowers the floor, if there is one. */
  raise_floor(height: number): void {
    const floor = this.scene.getObjectByName('floor');
    if (floor) floor.position.y = height;
  }

  /** Fits the light's shadow to the box that can move [m]; a smaller box gives a finer shadow. */
  light(box: Box3): void {
    const center = box.getCenter(new Vector3());
    const radius = Math.max(0.3, box.getSize(new Vector3()).length() * 0.75);
    this.sun.target.position.copy(center);
    this.sun.position.copy(center).add(new Vector3(-0.35, 1, 0.85).setLength(radius * 3));
    const view = this.sun.shadow.camera;
    [view.left, view.right, view.bottom, view.top] = [-radius, radius, -radius, radius];
    [view.near, view.far] = [radius, radius * 5];
    view.updateProjectionMatrix();
  }

  resize(width: number, height: number): void {
    this.renderer.setPixelRatio(this.quality.pixel_ratio);
    this.renderer.setSize(width, height, false);
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
}

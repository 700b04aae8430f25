import {
  FramebufferTexture,
  HalfFloatType,
  NoBlending,
  NormalBlending,
  RawShaderMaterial,
  GLSL3,
  Vector2,
  WebGLRenderTarget,
} from 'three';
import type { WebGLRenderer } from 'three';
import { FullScreenQuad } from 'three/examples/jsm/postprocessing/Pass.js';

/**
 * What is done with the picture on the canvas before it is seen: its edges are smoothed, or it is
 * averaged with others that are taken a little differently.
 */
export class Exposure {
  private frame: FramebufferTexture | null = null;
  private mean: WebGLRenderTarget | null = null;
  private size = new Vector2();
  private quad = new FullScreenQuad();
  private source = { frame: { value: null as unknown }, weight: { value: 1 } };
  private smoothing = pass(this.source, SMOOTHED);
  private adding = pass(this.source, SQUARED);
  private showing = pass(this.source, ROOTED);

  /** Whether pictures can be averaged. */
  readonly averages: boolean;

  constructor(private renderer: WebGLRenderer) {
    this.averages = ['EXT_color_buffer_float', 'EXT_color_buffer_half_float'].some((name) =>
      renderer.extensions.has(name),
    );
    this.adding.blending = NormalBlending;
    this.adding.transparent = true;
  }

  /** Smooths the edges of the picture on the canvas. */
  smooth(): void {
    this.take();
    this.draw(this.smoothing, null);
  }

  /** Takes the picture on the canvas as the k-th of the mean, and shows the mean so far. */
  add(k: number): void {
    this.take();
    this.mean ??= new WebGLRenderTarget(this.size.x, this.size.y, {
      type: HalfFloatType,
      depthBuffer: false,
    });
    this.source.weight.value = 1 / (k + 1);
    this.draw(this.adding, this.mean);
    this.source.frame.value = this.mean.texture;
    this.draw(this.showing, null);
  }

  private take(): void {
    const size = this.renderer.getDrawingBufferSize(new Vector2());
    if (!this.frame || !size.equals(this.size)) {
      this.dispose();
      this.size.copy(size);
      this.frame = new FramebufferTexture(size.x, size.y);
    }
    this.renderer.copyFramebufferToTexture(this.frame);
    this.source.frame.value = this.frame;
  }

  private draw(material: RawShaderMaterial, target: WebGLRenderTarget | null): void {
    const { renderer } = this;
    const clears = renderer.autoClear;
    renderer.autoClear = false;
    renderer.setRenderTarget(target);
    this.quad.material = material;
    this.quad.render(renderer);
    renderer.setRenderTarget(null);
    renderer.autoClear = clears;
  }

  private dispose(): void {
    this.frame?.dispose();
    this.mean?.dispose();
    this.frame = this.mean = null;
  }
}

function pass(source: RawShaderMaterial['uniforms'], fragment: string): RawShaderMaterial {
  return new RawShaderMaterial({
    glslVersion: GLSL3,
    uniforms: source,
    blending: NoBlending,
    depthTest: false,
    depthWrite: false,
    vertexShader: 'in vec3 position;\nvoid main() { gl_Position = vec4(position, 1.0); }',
    fragmentShader: `
      precision highp float;
      uniform sampler2D frame;
      uniform float weight;
      out vec4 color;
      ivec2 here;
      vec3 at(int x, int y) {
        ivec2 last = textureSize(frame, 0) - 1;
        return texelFetch(frame, clamp(here + ivec2(x, y), ivec2(0), last), 0).rgb;
      }
      float light(vec3 rgb) { return dot(rgb, vec3(0.3, 0.59, 0.11)); }
      void main() {
        here = ivec2(gl_FragCoord.xy);
        ${fragment}
      }`,
  });
}

// Means are taken of squares, which are nearly linear in light.
const SQUARED = 'vec3 rgb = at(0, 0); color = vec4(rgb * rgb, weight);';
const ROOTED = 'color = vec4(sqrt(at(0, 0)), 1.0);';

// Across an edge, light changes most; the pixel becomes the mean of its neighbours along the edge
// by as much as it sticks out of them.
const SMOOTHED = `
  vec3 rgb = at(0, 0);
  float middle = light(rgb);
  vec3 north = at(0, 1), south = at(0, -1), east = at(1, 0), west = at(-1, 0);
  float n = light(north), s = light(south), e = light(east), w = light(west);
  float contrast = max(max(n, s), max(max(e, w), middle)) - min(min(n, s), min(min(e, w), middle));
  float part = smoothstep(0.04, 0.2, contrast);
  bool level = abs(n - s) > abs(e - w);
  vec3 along = level ? east + west : north + south;
  vec3 across = level ? north + south : east + west;
  color = vec4(mix(rgb, rgb * 0.4 + along * 0.1 + across * 0.2, part), 1.0);
`;

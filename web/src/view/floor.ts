import { Mesh, PlaneGeometry, ShaderChunk, ShadowMaterial } from 'three';
import type { Palette } from './palette.js';

const GRID_RADIUS = 5; // at which the grid has faded out [m]

/** Shadows and a quiet grid of 10 cm with stronger metres, over the backdrop's colour. */
export class Floor {
  readonly mesh: Mesh;
  private material: ShadowMaterial;
  private uniforms = {
    grid_color: { value: null as unknown },
    grid_radius: { value: GRID_RADIUS },
    key_blur: { value: 1 },
  };

  constructor(palette: Palette) {
    const size = GRID_RADIUS * 2;
    this.material = new ShadowMaterial({ depthWrite: false });
    this.material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, this.uniforms);
      shader.vertexShader = shader.vertexShader.replace(
        'void main() {',
        'varying vec2 place;\nvoid main() {\nplace = position.xz;',
      );
      shader.fragmentShader = shader.fragmentShader
        .replace('#include <shadowmask_pars_fragment>', SHADOWS)
        .replace('void main() {', `${GRID_FUNCTIONS}\nvoid main() {`)
        .replace('#include <tonemapping_fragment>', GRID_OVER_SHADOW);
    };
    this.mesh = new Mesh(new PlaneGeometry(size, size).rotateX(-Math.PI / 2), this.material);
    this.mesh.name = 'floor';
    this.mesh.receiveShadow = true;
    this.mesh.renderOrder = -1;
    this.paint(palette);
  }

  /** How much more the key light's shadow is blurred than elsewhere: a floor throws none on itself. */
  set key_blur(factor: number) {
    this.uniforms.key_blur.value = factor;
  }

  paint({ grid, shadow, shade }: Palette): void {
    this.material.color.copy(shadow);
    this.material.opacity = shade;
    this.uniforms.grid_color.value = grid;
  }
}

// The key light is the first that throws shadows.
const SHADOWS = `
  uniform float key_blur;
  ${ShaderChunk.shadowmask_pars_fragment.replace(
    'directionalLight.shadowRadius',
    'directionalLight.shadowRadius * (UNROLLED_LOOP_INDEX == 0 ? key_blur : 1.0)',
  )}
`;

const GRID_FUNCTIONS = `
  uniform vec3 grid_color;
  uniform float grid_radius;
  varying vec2 place;
  float lines(vec2 at, float cell) {
    vec2 scaled = at / cell;
    vec2 width = fwidth(scaled);
    vec2 away = abs(fract(scaled - 0.5) - 0.5);
    vec2 line = 1.0 - smoothstep(0.4 * width, 1.2 * width, away);
    line *= 1.0 - smoothstep(0.2, 0.6, width);
    return max(line.x, line.y);
  }
`;

const GRID_OVER_SHADOW = `
  float fade = 1.0 - smoothstep(0.15, 0.8, length(place) / grid_radius);
  float strength = max(0.06 * lines(place, 0.1), 0.2 * lines(place, 1.0)) * fade;
  float shade = gl_FragColor.a * (1.0 - smoothstep(0.6, 1.0, length(place) / grid_radius));
  gl_FragColor.rgb = mix(gl_FragColor.rgb, grid_color, strength / max(1e-4, strength + shade));
  gl_FragColor.a = strength + shade - strength * shade;
`;

import { Color, Mesh, PlaneGeometry, ShadowMaterial } from 'three';

const GRID_COLOR = new Color('#8d877c');
const GRID_RADIUS = 6; // at which the grid has faded out [m]

/** Shadows and a grid of 10 cm with stronger metres, over the dome's colour. */
export function floor(height: number): Mesh {
  const geometry = new PlaneGeometry(GRID_RADIUS * 2, GRID_RADIUS * 2).rotateX(-Math.PI / 2);
  const material = new ShadowMaterial({ color: '#3b2f26', opacity: 0.25, depthWrite: false });
  material.onBeforeCompile = (shader) => {
    shader.uniforms.grid_color = { value: GRID_COLOR };
    shader.uniforms.grid_radius = { value: GRID_RADIUS };
    shader.vertexShader = shader.vertexShader.replace(
      'void main() {',
      'varying vec2 place;\nvoid main() {\nplace = position.xz;',
    );
    shader.fragmentShader = shader.fragmentShader
      .replace('void main() {', `${GRID_FUNCTIONS}\nvoid main() {`)
      .replace('#include <tonemapping_fragment>', GRID_OVER_SHADOW);
  };
  const mesh = new Mesh(geometry, material);
  mesh.name = 'floor';
  mesh.position.y = height;
  mesh.receiveShadow = true;
  mesh.renderOrder = -1;
  return mesh;
}

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
  float strength = max(0.1 * lines(place, 0.1), 0.3 * lines(place, 1.0)) * fade;
  float shade = gl_FragColor.a * (1.0 - smoothstep(0.6, 1.0, length(place) / grid_radius));
  gl_FragColor.rgb = mix(gl_FragColor.rgb, grid_color, strength / max(1e-4, strength + shade));
  gl_FragColor.a = strength + shade - strength * shade;
`;

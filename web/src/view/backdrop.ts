import { BackSide, Mesh, ShaderMaterial, SphereGeometry } from 'three';
import type { Palette } from './palette.js';

/** The background: the floor's colour up to the horizon, then the backdrop's. */
export class Backdrop {
  readonly mesh: Mesh;
  private material: ShaderMaterial;

  constructor(palette: Palette) {
    this.material = new ShaderMaterial({
      side: BackSide,
      depthWrite: false,
      uniforms: { floor_color: { value: null }, sky_color: { value: null } },
      vertexShader: `
        varying vec3 direction;
        void main() {
          direction = position;
          gl_Position = projectionMatrix * vec4(mat3(viewMatrix) * position, 1.0);
          gl_Position.z = gl_Position.w;
        }`,
      fragmentShader: `
        uniform vec3 floor_color;
        uniform vec3 sky_color;
        varying vec3 direction;
        void main() {
          float height = normalize(direction).y;
          vec3 color = mix(floor_color, sky_color, smoothstep(-0.08, 0.5, height));
          color *= 1.0 - 0.14 * smoothstep(0.1, 1.0, -height);
          float noise = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453);
          gl_FragColor = vec4(color + (noise - 0.5) / 255.0, 1.0);
          #include <colorspace_fragment>
        }`,
    });
    this.mesh = new Mesh(new SphereGeometry(1, 48, 24), this.material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = -2;
    this.paint(palette);
  }

  paint({ floor, sky }: Palette): void {
    this.material.uniforms.floor_color.value = floor;
    this.material.uniforms.sky_color.value = sky;
  }
}

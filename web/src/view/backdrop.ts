import { BackSide, Color, Mesh, ShaderMaterial, SphereGeometry } from 'three';

const FLOOR_COLOR = new Color('#e6e2db');
const SKY_COLOR = new Color('#f6f4f0');

/** The background: the floor's colour up to the horizon, then brighter. */
export function dome(): Mesh {
  const material = new ShaderMaterial({
    side: BackSide,
    depthWrite: false,
    uniforms: { floor_color: { value: FLOOR_COLOR }, sky_color: { value: SKY_COLOR } },
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
  const mesh = new Mesh(new SphereGeometry(1, 48, 24), material);
  mesh.frustumCulled = false;
  mesh.renderOrder = -2;
  return mesh;
}

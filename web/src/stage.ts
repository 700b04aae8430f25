import {
  BackSide,
  Box3,
  Color,
  DirectionalLight,
  HemisphereLight,
  Mesh,
  MeshBasicMaterial,
  PCFShadowMap,
  PlaneGeometry,
  PMREMGenerator,
  Scene,
  ShaderMaterial,
  ShadowMaterial,
  SphereGeometry,
  Vector3,
  WebGLRenderer,
  NeutralToneMapping,
} from 'three';

const FLOOR_COLOR = new Color('#e6e2db');
const SKY_COLOR = new Color('#f6f4f0');
const GRID_COLOR = new Color('#8d877c');
const GRID_RADIUS = 6; // at which the grid has faded out [m]
const MOST_PIXELS_PER_UNIT = 2;
const LEAST_PIXELS_PER_UNIT = 0.5;
const STILL_SUPERSAMPLING = 1.5; // without multisampling
const SLOW_PICTURE = 0.045; // that makes the following ones coarser [s]
const JUDGED_PICTURES = 5;

/** A studio: light, a floor with a grid that fades into the distance, and the renderer. */
export class Stage {
  readonly scene = new Scene();
  readonly renderer: WebGLRenderer;
  private software = draws_in_software();
  private coarseness = 1;
  private still = false;
  private slow_pictures = 0;
  private sun = new DirectionalLight('#fff4e6', 2.4);

  constructor(canvas: HTMLCanvasElement) {
    // Multisampling is too expensive for software renderers, and leaves cracks there.
    this.renderer = new WebGLRenderer({ canvas, antialias: !this.software });
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.scene.environment = soft_boxes(this.renderer);
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
    this.renderer.setPixelRatio(this.pixel_ratio());
    this.renderer.setSize(width, height, false);
  }

  /** Whether the picture was declared still. */
  get at_rest(): boolean {
    return this.still;
  }

  /**
   * Tells whether the picture is still, which leaves time for a fine one.
   * @returns whether the view must be resized
   */
  set_still(still: boolean): boolean {
    if (this.still === still) return false;
    this.still = still;
    this.slow_pictures = 0;
    return this.renderer.getPixelRatio() !== this.pixel_ratio();
  }

  /**
   * Draws coarser if a machine cannot keep up, because a lagging hand is worse than a soft edge.
   * @param interval between two consecutive pictures [s]
   * @returns whether the view must be resized
   */
  judge(interval: number): boolean {
    if (this.still) return false;
    this.slow_pictures = interval > SLOW_PICTURE ? this.slow_pictures + 1 : 0;
    const least = LEAST_PIXELS_PER_UNIT;
    if (this.slow_pictures < JUDGED_PICTURES || this.renderer.getPixelRatio() <= least) return false;
    this.coarseness *= Math.SQRT2;
    this.slow_pictures = 0;
    return true;
  }

  private pixel_ratio(): number {
    const finest = Math.min(MOST_PIXELS_PER_UNIT, window.devicePixelRatio);
    if (this.still) return this.software ? finest * STILL_SUPERSAMPLING : finest;
    return Math.min(finest, Math.max(LEAST_PIXELS_PER_UNIT, finest / this.coarseness));
  }
}

/** Whether the processor renders in place of a graphics card, as far as the browser tells. */
function draws_in_software(): boolean {
  const context = document.createElement('canvas').getContext('webgl2');
  if (!context) return true;
  const names = context.getExtension('WEBGL_debug_renderer_info');
  const name = context.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : context.RENDERER);
  context.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(String(name));
}

/** Light from large bright panels in a dim room, for soft reflections. */
function soft_boxes(renderer: WebGLRenderer) {
  const room = new Scene();
  const shell = new SphereGeometry(10, 24, 12);
  room.add(new Mesh(shell, new MeshBasicMaterial({ color: '#a9a6a2', side: BackSide })));
  const panels: [number, number, number, number][] = [
    [-6, 5, 5, 6],
    [7, 3, 2, 2.5],
    [0, 8, -3, 4],
  ];
  for (const [x, y, z, strength] of panels) {
    const panel = new Mesh(new PlaneGeometry(5, 5), new MeshBasicMaterial());
    panel.material.color.setScalar(strength);
    panel.position.set(x, y, z);
    panel.lookAt(0, 0, 0);
    room.add(panel);
  }
  const generator = new PMREMGenerator(renderer);
  const texture = generator.fromScene(room, 0.03).texture;
  generator.dispose();
  return texture;
}

/** The background: the floor's colour up to the horizon, then brighter. */
function dome(): Mesh {
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

/** Shadows and a grid of 10 cm with stronger metres, over the dome's colour. */
function floor(height: number): Mesh {
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

import type { Frame, MeshAnnouncement, MeshData, PoseSample, Vec3 } from '../../../proto/js/messages.js';
import { small_camera } from './small_camera.js';
import { small_shape, type Shape } from './small_shapes.js';

const OBJECT = '#8c9096';
const STILL: Pose = { position: [0, 0, 0], rotation: [0, 0, 0, 1] };

const VERTEX = `#version 300 es
uniform mat4 seen; uniform vec3 pivot; uniform vec3 position; uniform vec4 turn;
layout(location = 0) in vec3 place; layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 front; layout(location = 3) in vec3 back;
out vec3 at; out vec3 n; out vec3 front_color; out vec3 back_color;
vec3 turned(vec3 v) { return v + 2. * cross(turn.xyz, cross(turn.xyz, v) + turn.w * v); }
void main() {
  at = position + turned(place - pivot);
  n = turned(normal); front_color = front; back_color = back;
  gl_Position = seen * vec4(at, 1);
}`;
// Both sides are lit; the front of cloth is where its triangles are clockwise.
const FRAGMENT = `#version 300 es
precision highp float;
uniform vec3 eye;
in vec3 at; in vec3 n; in vec3 front_color; in vec3 back_color;
out vec4 color;
void main() {
  vec3 to_eye = normalize(eye - at);
  vec3 up = normalize(n) * sign(dot(n, to_eye));
  float key = max(dot(up, normalize(vec3(.45, .75, .5))), 0.);
  float light = .34 + .2 * up.y + .14 * dot(up, to_eye) + .6 * key;
  vec3 linear = pow(gl_FrontFacing ? back_color : front_color, vec3(2.2)) * light;
  color = vec4(pow(linear, vec3(1. / 2.2)), 1);
}`;

/** Where a body is: a point p of it is at `position` + `rotation` (p - pivot). */
interface Pose {
  position: ArrayLike<number>;
  rotation: ArrayLike<number>;
}

/** What the painter is given of the page. */
export interface Paints {
  smooth_normals(positions: Float32Array, triangles: Uint32Array, normals: Float32Array): void;
  /** Colours of each cloth's front and back, as `#rrggbb`. */
  cloth_colors(announcement: MeshAnnouncement): { front: string; back: string }[];
}

/** Triangles on the graphics card. */
interface Body {
  array: WebGLVertexArrayObject;
  places: WebGLBuffer;
  normals: WebGLBuffer;
  others: WebGLBuffer[];
  triangles: Uint32Array;
  pivot: Vec3;
  /** Index in the list of colliders; -1: the cloth. */
  place: number;
}

/** The cloth and the objects of one room, ready to be painted. */
export interface SmallScene {
  announcement: MeshAnnouncement;
  bodies: Body[];
  normals: Float32Array;
}

/** Paints rooms as small pictures, all by one WebGL context, each into a canvas of its own. */
export class SmallPainter {
  private canvas = document.createElement('canvas');
  private gl: WebGL2RenderingContext;
  private program: WebGLProgram;

  constructor(private paints: Paints) {
    const gl = this.canvas.getContext('webgl2', { alpha: true, antialias: true });
    if (!gl) throw new Error('no WebGL 2');
    this.gl = gl;
    this.program = program_of(gl);
    gl.enable(gl.DEPTH_TEST);
  }

  /** Takes a mesh to the graphics card. Give it back by `forget`. */
  prepare(announcement: MeshAnnouncement, data: MeshData): SmallScene {
    const colors = this.paints.cloth_colors(announcement);
    const [front, back] = [new Float32Array(3 * announcement.vertices), new Float32Array(3 * announcement.vertices)];
    for (const [k, { first_vertex, vertices }] of announcement.cloths.entries()) {
      for (let i = first_vertex; i < first_vertex + vertices; i++) {
        front.set(parts_of(colors[k].front), 3 * i);
        back.set(parts_of(colors[k].back), 3 * i);
      }
    }
    const cloth = { positions: data.restPositions, triangles: data.triangles };
    const bodies = [this.body(cloth, front, back, [0, 0, 0], -1)];
    for (const [place, collider] of announcement.colliders.entries()) {
      const shape = small_shape(collider, place, data);
      if (!shape) continue;
      const grey = new Float32Array(shape.positions.length).map((_, i) => parts_of(OBJECT)[i % 3]);
      bodies.push(this.body(shape, grey, grey, collider.pivot, place));
    }
    return { announcement, bodies, normals: new Float32Array(3 * announcement.vertices) };
  }

  /** Paints a frame of a scene into a canvas. */
  paint({ announcement, bodies, normals }: SmallScene, frame: Frame, canvas: HTMLCanvasElement): void {
    const { gl } = this;
    const { width, height } = canvas;
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(this.program);
    const { eye, matrix } = small_camera(announcement.view, frame.positions, width / height);
    gl.uniformMatrix4fv(this.uniform('seen'), false, matrix);
    gl.uniform3fv(this.uniform('eye'), eye);
    this.paints.smooth_normals(frame.positions, bodies[0].triangles, normals);
    this.write(bodies[0].places, frame.positions);
    this.write(bodies[0].normals, normals);
    for (const body of bodies) this.draw(body, pose_of(body, frame.poses));
    const context = canvas.getContext('2d')!;
    context.clearRect(0, 0, width, height);
    context.drawImage(this.canvas, 0, 0);
  }

  forget({ bodies }: SmallScene): void {
    for (const { array, places, normals, others } of bodies) {
      this.gl.deleteVertexArray(array);
      for (const buffer of [places, normals, ...others]) this.gl.deleteBuffer(buffer);
    }
  }

  /** Frees the context. */
  dispose(): void {
    this.gl.getExtension('WEBGL_lose_context')?.loseContext();
  }

  private draw({ array, triangles, pivot }: Body, { position, rotation }: Pose): void {
    const { gl } = this;
    gl.uniform3fv(this.uniform('pivot'), pivot);
    gl.uniform3fv(this.uniform('position'), [...Array.from(position)]);
    gl.uniform4fv(this.uniform('turn'), [...Array.from(rotation)]);
    gl.bindVertexArray(array);
    gl.drawElements(gl.TRIANGLES, triangles.length, gl.UNSIGNED_INT, 0);
    gl.bindVertexArray(null);
  }

  private body(shape: Shape, front: Float32Array, back: Float32Array, pivot: Vec3, place: number): Body {
    const { gl } = this;
    const { positions, triangles } = shape;
    const normals = new Float32Array(positions.length);
    this.paints.smooth_normals(positions, triangles, normals);
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    const buffers = [positions, normals, front, back].map((values, attribute) => {
      const buffer = gl.createBuffer();
      this.write(buffer, values);
      gl.enableVertexAttribArray(attribute);
      gl.vertexAttribPointer(attribute, 3, gl.FLOAT, false, 0, 0);
      return buffer;
    });
    const order = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, order);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    const [places, shades, ...colors] = buffers;
    return { array, places, normals: shades, others: [...colors, order], triangles, pivot, place };
  }

  private write(buffer: WebGLBuffer, values: Float32Array): void {
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, buffer);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, values, this.gl.DYNAMIC_DRAW);
  }

  private uniform(name: string): WebGLUniformLocation | null {
    return this.gl.getUniformLocation(this.program, name);
  }
}

/** Objects without a pose stand as defined. */
function pose_of({ place, pivot }: Body, poses: PoseSample[]): Pose {
  return poses.find(({ collider }) => collider === place) ?? { ...STILL, position: pivot };
}

function parts_of(color: string): number[] {
  return [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16) / 255);
}

function program_of(gl: WebGL2RenderingContext): WebGLProgram {
  const program = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]] as const) {
    const shader = gl.createShader(type)!;
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  return program;
}

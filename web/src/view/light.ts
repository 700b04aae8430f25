import {
  BackSide,
  Color,
  DirectionalLight,
  Group,
  HemisphereLight,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  PMREMGenerator,
  Scene,
  SphereGeometry,
  Vector3,
} from 'three';
import type { Box3, WebGLRenderer, WebGLRenderTarget } from 'three';
import type { Sample } from './samples.js';

const KEY = new Vector3(-0.42, 1, 0.8).normalize(); // towards the key light, front left and above
const BACK = new Vector3(0.85, 0.55, -0.45).normalize(); // towards the fill, aside, for dark sides of folds
const KEY_SPREAD = 0.07; // tangent of half the angle under which the key light is seen
const SKY_SPREAD = 0.9; // the same for the light from above
const KEY_BLUR = 0.012; // of the shadow's edge, also where its light moves from exposure to exposure [m]
const SKY_BLUR = 0.05; // [m]
// What has to be bridged between the shadows of exposures, by the root of their number [texels].
const SKY_STEP = 44;
const KEY_STEP = 48; // on the floor, where what hangs high throws shadows far apart
const VARIETY = 0.6; // by which that differs from exposure to exposure, so that what is left of each differs
const MAP_SIZES = { key: 1024, sky: 512 }; // [texels]
// From above and below: at first without anything else from there, then beside that of the room. What
// comes from below is what a floor of middle brightness throws back of the key light.
const HEMISPHERE = { simple: ['#ffffff', '#b9b2a8', 1.1], beside_room: ['#333333', '#ddd5c9', 0.6] } as const;
const CONTACT = 0.85; // part of the light from above that its shadows take
export const REFLECTED = 0.5; // part of the reflections' light that is used
const ROOM = '#8f8d8a';
/** Bright panels of the room, whose middle is where the cloth is: places [m], sides [m], and radiances. */
const PANELS: [number, number, number, number, number][] = [
  [-6, 5, 5, 5, 5.5],
  [7, 3, 2, 4, 2],
  [0, 8, -1, 5, 3],
  [5, 3.5, -7, 5, 4.5],
  [-7, 2.5, -5, 3, 3],
];

/**
 * How much light there is. Simple: without shadows and without the room, whose preparation takes time.
 * Quick: with the key light's shadow, its edge hard, and what the room gives on the whole. Whole: with
 * both shadows and the room's reflections.
 */
export type Lighting = 'simple' | 'quick' | 'whole';

/**
 * Light of a studio: a key light with shadows, a wide one from above whose shadows are those of
 * contact, a fill from behind without any, and a room of soft boxes. At first it is simple.
 */
export class Light {
  readonly group = new Group();
  private key = new DirectionalLight('#fff3e4', 2.1);
  private sky = new DirectionalLight('#f2f5ff', 0.75);
  private back = new DirectionalLight('#e3ebff', 4.2);
  private hemisphere = new HemisphereLight(...HEMISPHERE.simple);
  private room = light_of_room();
  private lighting_: Lighting = 'simple';
  private center = new Vector3();
  private radius = 1; // of what is lit [m]

  constructor() {
    this.group.add(this.hemisphere, this.room);
    this.room.visible = false;
    this.sky.shadow.intensity = CONTACT;
    for (const light of [this.key, this.sky, this.back]) this.group.add(light, light.target);
    for (const [light, size] of [[this.key, MAP_SIZES.key], [this.sky, MAP_SIZES.sky]] as const) {
      light.shadow.mapSize.set(size, size);
      light.shadow.bias = -0.0004;
      light.shadow.normalBias = 0.012;
    }
    this.back.position.copy(BACK);
    this.show(null);
  }

  set lighting(lighting: Lighting) {
    this.lighting_ = lighting;
    this.key.castShadow = lighting !== 'simple';
    this.sky.castShadow = lighting === 'whole';
    this.room.visible = lighting === 'quick'; // else by reflections
    const [above, below, intensity] = HEMISPHERE[lighting === 'simple' ? 'simple' : 'beside_room'];
    this.hemisphere.color.set(above);
    this.hemisphere.groundColor.set(below);
    this.hemisphere.intensity = intensity;
    this.show(null);
  }

  /** Fits the shadows to the box that can move [m]; a smaller box gives finer ones. */
  fit(box: Box3): void {
    box.getCenter(this.center);
    this.radius = Math.max(0.06, box.getSize(new Vector3()).length() * 0.75);
    for (const light of [this.key, this.sky]) {
      light.target.position.copy(this.center);
      const view = light.shadow.camera;
      [view.left, view.right, view.bottom, view.top] = [-1, 1, -1, 1].map((end) => end * this.radius);
      [view.near, view.far] = [this.radius * 0.5, this.radius * 5.5];
      view.updateProjectionMatrix();
      light.shadow.normalBias = Math.min(0.012, this.radius * 0.01);
    }
    this.show(null);
  }

  /**
   * Moves the lights to a point of their areas, so that the mean of many pictures has the shadows of
   * areas; null: to their middles, with shadows that are blurred instead.
   * @param count of those pictures
   * @returns how much more the key light's shadow is to be blurred on the floor
   */
  show(sample: Sample | null, count = 1): number {
    const texel = (size: number) => (2 * this.radius) / size;
    const hard = this.lighting_ !== 'whole';
    const blur = (metres: number, size: number) => (hard ? 1 : Math.min(14, Math.max(1, metres / texel(size))));
    this.key.shadow.radius = blur(KEY_BLUR, MAP_SIZES.key);
    const part = sample ? (1 + VARIETY * sample.pixel[0]) / Math.sqrt(count) : 0;
    this.sky.shadow.radius = sample ? SKY_STEP * part : blur(SKY_BLUR, MAP_SIZES.sky);
    this.place(this.key, KEY, KEY_SPREAD, sample?.key);
    this.place(this.sky, new Vector3(0, 1, 0.02), SKY_SPREAD, sample?.sky);
    return Math.max(1, (KEY_STEP * part) / this.key.shadow.radius);
  }

  private place(light: DirectionalLight, to: Vector3, spread: number, at = [0, 0]): void {
    const side = new Vector3(0, 0, -1).cross(to).normalize();
    const direction = to.clone().addScaledVector(side, at[0] * spread);
    direction.addScaledVector(to.clone().cross(side).normalize(), at[1] * spread);
    light.position.copy(this.center).add(direction.setLength(this.radius * 3));
  }
}

/** Whether an address asks for light without reflections and shadows: `?light=simple`. */
export const asks_for_simple_light = (search: string) => new URLSearchParams(search).get('light') === 'simple';

/**
 * What comes from the room, without where exactly: light that changes evenly with the direction of a
 * surface, which is the mean of what comes from all sides and the part that grows with its cosine
 * (Ramamoorthi and Hanrahan 2001, "An efficient representation for irradiance environment maps").
 */
export function light_of_room(): HemisphereLight {
  const wall = new Color(ROOM);
  const sum = wall.clone().multiplyScalar(4 * Math.PI); // over all directions
  const way = new Vector3(); // the same of directions by their light
  for (const [x, y, z, size, radiance] of PANELS) {
    const place = new Vector3(x, y, z);
    const angle = 4 * Math.asin(size ** 2 / (size ** 2 + 4 * place.lengthSq())); // of the panel, seen from there [sr]
    sum.add(wall.clone().multiplyScalar(-angle)).addScalar(radiance * angle);
    way.addScaledVector(place.normalize(), (radiance - wall.g) * angle);
  }
  const mean = sum.multiplyScalar(REFLECTED / 4);
  const slope = (way.length() * REFLECTED) / 2;
  const light = new HemisphereLight(mean.clone().addScalar(slope), mean.addScalar(-slope));
  light.position.copy(way);
  return light;
}

/**
 * Reflections of large bright panels in a dim room, prepared for rough and smooth surfaces. They
 * have to be made again when the graphics were lost.
 */
export function reflections(renderer: WebGLRenderer): WebGLRenderTarget {
  const room = soft_boxes();
  const generator = new PMREMGenerator(renderer);
  const target = generator.fromScene(room, 0.03);
  generator.dispose();
  room.traverse((child) => {
    if (!(child instanceof Mesh)) return;
    child.geometry.dispose();
    child.material.dispose();
  });
  return target;
}

export function soft_boxes(): Scene {
  const room = new Scene();
  const shell = new SphereGeometry(10, 24, 12);
  room.add(new Mesh(shell, new MeshBasicMaterial({ color: ROOM, side: BackSide })));
  for (const [x, y, z, size, strength] of PANELS) {
    const panel = new Mesh(new PlaneGeometry(size, size), new MeshBasicMaterial());
    panel.material.color.setScalar(strength);
    panel.position.set(x, y, z);
    panel.lookAt(0, 0, 0);
    room.add(panel);
  }
  return room;
}

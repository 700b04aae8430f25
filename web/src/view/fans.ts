import {
  CircleGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  DoubleSide,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshStandardMaterial,
  Quaternion,
  SphereGeometry,
  TorusGeometry,
  Vector3,
} from 'three';
import type { BufferGeometry, Vector2 } from 'three';
import type { Fan, Vec3 } from '../../../proto/js/messages.js';
import type { OrbitCamera } from './camera.js';

const FORWARD = new Vector3(0, 0, 1);
const SHOWN_LENGTH = 0.6; // of the jet, up to the handle that turns it [m]
const REACH = 18; // of the pointer around a handle [pixels]
const BLADES = 3;
const TURN = 0.35; // of the blades at a speed of 1 m/s [rad a tick]
// The protocol's defaults for a fan's optional fields.
const RADIUS = 0.25;
const SPREAD = 0.2;
const SPEED = 5;
// A new fan stands beside the line of sight, so that it does not hide its target.
const ASIDE = 0.75; // from the line of sight [rad]
const DISTANCE = 0.9; // from its target [m]

/** The handle of a fan: its place, or its aim. */
export type FanPart = 'place' | 'aim';

export interface FanHit {
  index: number;
  part: FanPart;
  position: Vec3;
}

/** The position of a handle. */
function handle_of(fan: Fan, part: FanPart): Vec3 {
  if (part === 'place') return [...fan.position];
  const direction = new Vector3(...fan.direction).setLength(SHOWN_LENGTH);
  return new Vector3(...fan.position).add(direction).toArray();
}

/** The same fan with a handle moved. */
export function with_handle(fan: Fan, part: FanPart, to: Vec3): Fan {
  if (part === 'place') return { ...fan, position: to };
  const direction = new Vector3(...to).sub(new Vector3(...fan.position));
  if (direction.length() < 1e-3) return fan;
  return { ...fan, direction: direction.normalize().toArray() };
}

/** The fans of the room: a ring with blades at the outlet, the jet, and a handle to aim it. */
export class Fans {
  readonly group = new Group();
  list: Fan[] = [];
  private metal = new MeshStandardMaterial({ color: '#4d555e', roughness: 0.45 });
  private blade = new MeshStandardMaterial({ color: '#7d8791', roughness: 0.5, side: DoubleSide });
  private air = new MeshBasicMaterial({
    color: new Color('#6f9cc4'),
    transparent: true,
    opacity: 0.16,
    depthWrite: false,
    side: DoubleSide,
  });
  private rotors: Group[] = [];
  private unanswered = 0;

  /**
   * Shows the server's fans, unless an answer to the own hand's changes is pending: until then they
   * are older than the picture.
   * @returns whether anything changed
   */
  receive(fans: Fan[]): boolean {
    return this.unanswered === 0 && this.show(fans);
  }

  /** @param answer of the server to a change of the fans */
  told(answer: Promise<unknown>): void {
    const answered = () => void (this.unanswered -= 1);
    this.unanswered += 1;
    answer.then(answered, answered);
  }

  /** @returns whether anything changed */
  show(fans: Fan[]): boolean {
    if (JSON.stringify(fans) === JSON.stringify(this.list)) return false;
    this.list = structuredClone(fans);
    this.group.traverse((part) => part instanceof Mesh && part.geometry.dispose());
    this.group.clear();
    this.rotors = [];
    for (const fan of fans) this.group.add(this.draw(fan));
    return true;
  }

  /** Turns the blades to their angle at a tick. */
  spin(tick: number): void {
    this.rotors.forEach((rotor, index) => {
      rotor.rotation.z = tick * TURN * (this.list[index].speed ?? SPEED);
    });
  }

  /** The handle under the pointer. */
  at(point: Vector2, { camera }: OrbitCamera, width: number, height: number): FanHit | null {
    for (const [index, fan] of this.list.entries()) {
      for (const part of ['aim', 'place'] as const) {
        const position = handle_of(fan, part);
        const place = new Vector3(...position).project(camera);
        const dx = ((place.x - point.x) / 2) * width;
        const dy = ((place.y - point.y) / 2) * height;
        if (Math.abs(place.z) < 1 && Math.hypot(dx, dy) < REACH) return { index, part, position };
      }
    }
    return null;
  }

  private draw(fan: Fan): Group {
    const { radius = RADIUS, spread = SPREAD } = fan;
    const drawn = new Group();
    const add = (geometry: BufferGeometry, material: MeshBasicMaterial | MeshStandardMaterial, to = drawn) => {
      const mesh = new Mesh(geometry, material);
      mesh.castShadow = material !== this.air;
      to.add(mesh);
      return mesh;
    };
    add(new TorusGeometry(radius, 0.012, 12, 48), this.metal);
    add(new SphereGeometry(Math.min(0.03, radius / 3), 24, 16), this.metal);
    const rotor = new Group();
    for (let n = 0; n < BLADES; n++) {
      const blade = add(new CircleGeometry(radius * 0.44, 24), this.blade, rotor);
      blade.geometry.scale(1, 0.42, 1).rotateX(0.5).translate(radius * 0.5, 0, 0);
      blade.rotation.z = (n * 2 * Math.PI) / BLADES;
    }
    drawn.add(rotor);
    this.rotors.push(rotor);
    const end = radius + spread * SHOWN_LENGTH;
    const jet = new CylinderGeometry(end, radius, SHOWN_LENGTH, 48, 1, true);
    add(jet.rotateX(Math.PI / 2).translate(0, 0, SHOWN_LENGTH / 2), this.air);
    const tip = new ConeGeometry(0.028, 0.07, 24);
    add(tip.rotateX(Math.PI / 2).translate(0, 0, SHOWN_LENGTH), this.metal);
    const shaft = new CylinderGeometry(0.004, 0.004, SHOWN_LENGTH, 8);
    add(shaft.rotateX(Math.PI / 2).translate(0, 0, SHOWN_LENGTH / 2), this.metal);
    drawn.position.set(...fan.position);
    const direction = new Vector3(...fan.direction).normalize();
    drawn.setRotationFromQuaternion(new Quaternion().setFromUnitVectors(FORWARD, direction));
    return drawn;
  }
}

/** A fan beside the line of sight that blows at the view's target. */
export function fan_of_view(camera: OrbitCamera): Fan {
  const { position, target } = camera.description();
  const aim = new Vector3(...target);
  const direction = aim.clone().sub(new Vector3(...position));
  const distance = Math.min(DISTANCE, direction.length() * 0.5);
  direction.applyAxisAngle(new Vector3(0, 1, 0), -ASIDE).normalize();
  return {
    position: aim.addScaledVector(direction, -distance).toArray(),
    direction: direction.toArray(),
    speed: SPEED,
    radius: RADIUS,
    spread: SPREAD,
    reach: 1.5,
  };
}

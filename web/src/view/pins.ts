import { Group, Mesh, MeshStandardMaterial, SphereGeometry, Vector3 } from 'three';
import type { PerspectiveCamera, Vector2 } from 'three';
import type { Pin } from '../../../proto/js/messages.js';

const PIN_RADIUS = 0.009; // of a head [m]
const SMALL_CLOTH = 1; // smaller cloths get smaller heads [m]
const SAME_PLACE = 1; // between pins that are at one place [pixels]
const SCENE_COLOR = '#4a4e55';

/** Pin heads where particles are fixed, in the colours of their owners. */
export class Pins {
  readonly group = new Group();
  private sphere = new SphereGeometry(PIN_RADIUS, 24, 16);
  private scale = 1;
  list: Pin[] = [];

  /** @param extent of the cloths: their longest side [m] */
  fit(extent: number): void {
    this.scale = Math.min(1, extent / SMALL_CLOTH);
    for (const head of this.group.children) head.scale.setScalar(this.scale);
  }

  /** @param color of a viewer's number, or null if that viewer has left */
  set(list: Pin[], color: (viewer: number) => string | null): void {
    this.list = list;
    for (const head of this.group.children as Mesh[]) {
      (head.material as MeshStandardMaterial).dispose();
    }
    this.group.clear();
    for (const pin of list) {
      const material = new MeshStandardMaterial({
        color: (pin.viewer && color(pin.viewer)) || SCENE_COLOR,
        roughness: 0.25,
      });
      const head = new Mesh(this.sphere, material);
      head.position.set(...pin.position);
      head.scale.setScalar(this.scale);
      head.castShadow = true;
      this.group.add(head);
    }
  }

  /** Moves the heads to their particles in the shown cloth: a pin may be moving. */
  follow(positions: Float32Array): void {
    this.list.forEach(({ particle }, k) => {
      if (particle * 3 + 2 < positions.length)
        this.group.children[k]?.position.fromArray(positions, particle * 3);
    });
  }

  /** Pins at the place nearest to a point of the view, and those that hold a particle. */
  at(
    { point, particle, pixels }: PinSearch,
    camera: PerspectiveCamera,
    width: number,
    height: number,
  ): Pin[] {
    const distances = this.list.map((pin, k) => {
      if (!point) return Infinity;
      // The position of a fixed pin is known before the picture shows it.
      const at = pin.target ? this.group.children[k].position : new Vector3(...pin.position);
      const place = at.clone().project(camera);
      const dx = ((place.x - point.x) / 2) * width;
      const dy = ((place.y - point.y) / 2) * height;
      return Math.abs(place.z) < 1 ? Math.hypot(dx, dy) : Infinity;
    });
    const nearest = Math.min(pixels, ...distances) + SAME_PLACE;
    return this.list.filter(
      (pin, k) => pin.particle === particle || distances[k] < Math.min(pixels, nearest),
    );
  }
}

/** Where pins are looked for: within some pixels of a point, in normalised coordinates, and at a particle. */
export interface PinSearch {
  point: Vector2 | null;
  particle: number | null;
  pixels: number;
}

import type { Page } from './page.js';

/** What tests may read of the page; everything is a copy. */
export function expose_probe(page: Page): void {
  const probe = {
    get phase() {
      return page.phase;
    },
    get viewer() {
      return page.client.viewer;
    },
    get scene() {
      return page.world?.announcement.scene ?? null;
    },
    get tick() {
      return page.world?.playback.tick ?? -1;
    },
    get paused() {
      return page.state?.paused ?? null;
    },
    get input() {
      return page.input.state;
    },
    get hovering() {
      return page.hovered !== null;
    },
    get positions() {
      return page.world ? [...page.world.playback.positions] : [];
    },
    get triangles() {
      return page.world ? [...page.world.triangles] : [];
    },
    get camera() {
      const { camera } = page.orbit;
      return {
        view: camera.matrixWorldInverse.toArray(),
        projection: camera.projectionMatrix.toArray(),
        position: camera.position.toArray(),
      };
    },
    get size() {
      return { width: page.canvas.clientWidth, height: page.canvas.clientHeight };
    },
    get hands() {
      return structuredClone(page.hands.shown);
    },
    /** Objects as they are drawn, with the place of their pivot [m] and their turn [x, y, z, w]. */
    get objects() {
      return page.world?.object_poses() ?? [];
    },
    get pins() {
      return structuredClone(page.pins.list);
    },
    /** Where the heads of the pins are drawn [m]. */
    get pin_heads() {
      return page.pins.group.children.map(({ position }) => position.toArray());
    },
    get fans() {
      return structuredClone(page.fans.list);
    },
    /** Lines of the boxes, six numbers each, and the tick that they are of. */
    get boxes() {
      const { boxes, tick } = page.box_view;
      return { lines: boxes.drawn(), tick };
    },
    /** Pictures drawn so far; it stands still where nothing changes. */
    get pictures() {
      return page.pictures;
    },
    /** Whether the picture is drawn as finely as it can be, as it is where nothing changes. */
    get fine() {
      return page.fine;
    },
  };
  Object.defineProperty(window, 'weft', { value: Object.freeze(probe) });
}

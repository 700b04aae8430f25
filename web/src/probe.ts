import type { Page } from './page.js';

/** The page's state as tests may read it; all values are copies. */
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
      return page.holding.hovered !== null;
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
    /** Objects as drawn: position of the pivot [m] and rotation [x, y, z, w]. */
    get objects() {
      return page.world?.object_poses() ?? [];
    },
    get pins() {
      return structuredClone(page.pins.list);
    },
    /** Drawn positions of the pins' heads [m]. */
    get pin_heads() {
      return page.pins.group.children.map(({ position }) => position.toArray());
    },
    get fans() {
      return structuredClone(page.fans.list);
    },
    /** Lines of the boxes, six numbers each, and their tick. */
    get boxes() {
      const { boxes, tick } = page.box_view;
      return { lines: boxes.drawn(), tick };
    },
    /** Pictures drawn so far; constant while nothing changes. */
    get pictures() {
      return page.pictures;
    },
    /** Whether the picture is as fine as possible, as it is while nothing changes. */
    get fine() {
      return page.fine;
    },
  };
  Object.defineProperty(window, 'weft', { value: Object.freeze(probe) });
}

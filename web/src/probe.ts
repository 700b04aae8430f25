import type { Page } from './page.js';
import { pattern } from './view/fabric.js';
import type { Look } from '../../proto/js/messages.js';
import { cloth_mask } from './view/mask.js';

/** The page's state as tests may read it; all values are copies. */
export function expose_probe(page: Page): void {
  const probe = {
    get phase() {
      return page.phase;
    },
    get viewer() {
      return page.client.viewer;
    },
    /** The room that the server says the page is in. */
    get room() {
      return page.client.welcome?.room ?? null;
    },
    get scene() {
      return page.world?.announcement.scene ?? null;
    },
    /** The number of the scene's cloths. */
    get cloths() {
      return page.world?.announcement.cloths.length ?? 0;
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
    /** The ring around what a hand would take: points [m], and its radius in the fabric [m]. */
    get ring() {
      return { points: structuredClone(page.reticle.shown), radius: page.holding.radius };
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
    /** Others' cursors as drawn, and by whose camera this viewer sees. */
    get company() {
      const { cursors, company } = page.crowd;
      return { cursors: structuredClone(cursors.shown), follows: company.follows };
    },
    get fans() {
      return structuredClone(page.fans.list);
    },
    /** Lines of the boxes, six numbers each, and their tick. */
    get boxes() {
      const { boxes, tick } = page.box_view;
      return { lines: boxes.drawn(), tick };
    },
    /** Lines of a textile test's marks, three numbers per point. */
    get laboratory() {
      return page.laboratory.drawn();
    },
    /** Pictures drawn so far; constant while nothing changes. */
    get pictures() {
      return page.pictures;
    },
    /** Whether the light has its reflections and shadows, which follow the first pictures. */
    get lit() {
      return page.lit;
    },
    /** Whether the picture is as fine as possible, as it is while nothing changes. */
    get fine() {
      return page.fine;
    },
    /** The number of the cloth in each pixel, 0 for none, as bytes in base64; row by row from the top. */
    cloth_mask(): string {
      const { world, stage, orbit } = page;
      if (!world) return '';
      return base64(cloth_mask(stage.renderer, stage.scene, orbit.camera, world.parts, probe.size));
    },
    /** Resolves once the server has done all that the page has asked for so far. */
    async done(): Promise<void> {
      await page.client.query('state');
    },
    /** Draws the cloths with other looks than the server's. */
    dress(looks: Look[]): void {
      page.world?.dress(looks);
      page.redraw();
    },
    /** Draws weaves and hems, or cloth of one colour. */
    show_pattern(shown: boolean): void {
      pattern.value = shown ? 1 : 0;
      page.redraw();
    },
  };
  Object.defineProperty(window, 'weft', { value: Object.freeze(probe) });
}

function base64(bytes: Uint8Array): string {
  let text = '';
  for (let i = 0; i < bytes.length; i += 0x8000) {
    text += String.fromCharCode(...bytes.subarray(i, i + 0x8000));
  }
  return btoa(text);
}

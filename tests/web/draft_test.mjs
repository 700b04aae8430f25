import assert from 'node:assert/strict';
import test from 'node:test';
import { camera_at_rest, read, until } from './support/browser.mjs';
import { with_page } from './support/default_page.mjs';
import { bounded, shows_last_tick } from './support/default_scene.mjs';
import { made_up_canvas, make_up_browser } from './support/made_up_gl.mjs';
import { mesh_of } from './support/made_up_mesh.mjs';
import { import_page_module } from './support/page_module.mjs';
import { drawn_cloth, picture_of } from './support/silhouette.mjs';

// Pictures of what moves where the processor draws: drafts, that must look like the fine picture.

make_up_browser('SwiftShader');
// As one, because the renderer knows geometries by numbers, which two copies of three give twice.
const page_modules = await import_page_module('view/light', 'view/stage', 'view/world_view', 'view/camera');
const { light_of_room, soft_boxes, REFLECTED, Stage, WorldView, OrbitCamera } = page_modules;

/** The light of a room along a ray from its middle: that of the panel there, or of the wall. */
function light_along(ray, [wall, ...panels]) {
  const seen = panels.find(({ matrixWorld, geometry }) => {
    const [right, up, out, place] = [0, 4, 8, 12].map((k) => matrixWorld.elements.slice(k, k + 3));
    const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const distance = dot(place, out) / dot(ray, out);
    const half = geometry.parameters.width / 2;
    const within = (axis) => Math.abs(distance * dot(ray, axis) - dot(place, axis)) < half;
    return distance > 0 && within(right) && within(up);
  });
  return (seen ?? wall).material.color.toArray();
}

test('the even light of a draft has the mean and the slope of the room’s, found by rays', () => {
  const RAYS = 50_000;
  const room = soft_boxes();
  room.updateMatrixWorld();
  const sum = [0, 0, 0];
  const way = [0, 0, 0]; // directions by their green light
  for (let k = 0; k < RAYS; k++) {
    const height = 1 - (2 * k + 1) / RAYS;
    const angle = k * 2.399963;
    const across = Math.sqrt(1 - height * height);
    const ray = [across * Math.cos(angle), height, across * Math.sin(angle)];
    const light = light_along(ray, room.children);
    for (let i = 0; i < 3; i++) {
      sum[i] += (light[i] * 4 * Math.PI) / RAYS;
      way[i] += (ray[i] * light[1] * 4 * Math.PI) / RAYS;
    }
  }
  const { color, groundColor, position } = light_of_room();
  const [above, below] = [color.toArray(), groundColor.toArray()];
  for (let i = 0; i < 3; i++) {
    const mean = (above[i] + below[i]) / 2 / ((REFLECTED * sum[i]) / 4);
    assert.ok(Math.abs(mean - 1) < 0.01, `mean of part ${i}: ${mean} of the room's`);
  }
  const length = Math.hypot(...way);
  const slope = (above[1] - below[1]) / 2 / ((REFLECTED * length) / 2);
  assert.ok(Math.abs(slope - 1) < 0.03, `slope: ${slope} of the room's`);
  const cosine = position.toArray().reduce((dot, part, i) => dot + part * way[i], 0) / position.length() / length;
  assert.ok(cosine > 0.998, `it comes from the room's brightest side, by a cosine of ${cosine}`);
});

test('a draft has fewer triangles and no reflections, and to rest or to move again makes no program', async () => {
  const made = {};
  const stage = new Stage(made_up_canvas({}, made), false, { lost() {}, changed() {} });
  const { camera } = new OrbitCamera();
  const { announcement, data } = mesh_of(40, []);
  const world = new WorldView(announcement, data, stage);
  assert.ok(stage.drafts);
  const triangles = () => stage.renderer.info.render.triangles;
  const draft = () => {
    world.look_from(camera, true);
    stage.draw(camera);
    return triangles();
  };
  const rest = () => {
    world.look_from(camera, false);
    while (!stage.fine) stage.expose(camera);
  };
  draft();
  await stage.complete(camera);
  draft();
  assert.equal(stage.scene.environment, null);
  rest();
  assert.notEqual(stage.scene.environment, null);
  const programs = made.Program;
  for (let time = 0; time < 3; time++) {
    draft();
    rest();
  }
  assert.equal(made.Program, programs);
  const counts = [true, false].map((rough) => {
    world.look_from(camera, rough);
    const [group] = stage.scene.children.filter((child) => child === world.parts.cloth);
    return group.children[0].geometry.index.count / 3;
  });
  assert.ok(counts[1] > 3 * counts[0] && counts[0] >= data.triangles.length / 3, `${counts}`);
});

/** Bytes of the picture that the page draws next, at the size of the page's layout. */
async function draft_of(page) {
  const draft = await page.evaluate(
    () =>
      new Promise((done) =>
        requestAnimationFrame(() => {
          weft.show_pattern(true); // which draws it again
          // The page's own callback of a picture was asked for earlier, so that it has drawn by then.
          requestAnimationFrame(() => {
            const { width, height } = weft.size;
            const copy = new OffscreenCanvas(width, height).getContext('2d');
            copy.drawImage(document.getElementById('view'), 0, 0, width, height);
            done({ fine: weft.fine, bytes: [...copy.getImageData(0, 0, width, height).data] });
          });
        }),
      ),
  );
  assert.equal(draft.fine, false);
  return draft.bytes;
}

/** Mean red, green and blue where a mask is set, 0 to 255. */
function mean_within(mask, bytes) {
  const pixels = [...mask.keys()].filter((pixel) => mask[pixel]);
  return [0, 1, 2].map((part) => pixels.reduce((sum, pixel) => sum + bytes[pixel * 4 + part], 0) / pixels.length);
}

test('cloth of a draft has the mean colour of the fine picture of the same moment, to 4 %', bounded, () =>
  with_page({ width: 640, height: 480, paused: true, simple: false }, async (page, script) => {
    await until(() => read(page, 'lit'), 'the light is whole');
    for (const ticks of [0, 90]) {
      if (ticks) await script.advance(ticks);
      await shows_last_tick(page, script);
      await camera_at_rest(page);
      const draft = await draft_of(page);
      await until(() => read(page, 'fine'), 'the picture is a fine one');
      const mask = await drawn_cloth(page);
      const fine = mean_within(mask, (await picture_of(page)).data);
      const drafted = mean_within(mask, draft);
      const off = fine.map((part, i) => Math.abs(drafted[i] / part - 1));
      assert.ok(Math.max(...off) < 0.04, `after ${ticks} ticks ${drafted} in place of ${fine}`);
    }
  }),
);

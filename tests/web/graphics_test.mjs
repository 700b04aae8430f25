import assert from 'node:assert/strict';
import test from 'node:test';
import { made_up_canvas, make_up_browser } from './support/made_up_gl.mjs';
import { mesh_of } from './support/made_up_mesh.mjs';
import { import_page_module } from './support/page_module.mjs';

// What the page keeps on the graphics card, with graphics that are made up.

make_up_browser();
// As one, because the renderer knows geometries by numbers, which two copies of three give twice.
const { Stage, WorldView, Reticle, Hands, OrbitCamera } = await import_page_module(
  'view/stage', 'view/world_view', 'view/reticle', 'view/hands', 'view/camera',
);

const EXPOSURES = 24;
const place = { pivot: [0, 0, 0] };
const GROUND = { ...place, name: 'ground', kind: 'plane', point: [0, 0, 0], normal: [0, 1, 0] };
const BALL = { ...place, name: 'ball', kind: 'sphere', center: [0, 0.3, 0], radius: 0.2 };
const BOARD = {
  ...place, name: 'board', kind: 'box', center: [0, 0.1, 0], half_extents: [0.3, 0.02, 0.3],
  orientation: [0, 0, 0, 1],
};

test('thirty scenes one after the other leave no buffer, vertex array or texture behind', async () => {
  const alive = {};
  const stage = new Stage(made_up_canvas(alive), false, { lost() {}, changed() {} });
  const { camera } = new OrbitCamera();
  const meshes = [mesh_of(6, [GROUND]), mesh_of(9, [GROUND, BALL, BOARD]), mesh_of(4, [])];
  const show = async ({ announcement, data }) => {
    const world = new WorldView(announcement, data, stage);
    world.look_from(camera);
    stage.draw(camera);
    await stage.complete(camera);
    stage.draw(camera);
    for (let i = 0; i < EXPOSURES; i++) stage.expose(camera);
    assert.ok(stage.fine);
    const { Buffer, VertexArray, Texture, Framebuffer } = alive;
    world.dispose();
    return { Buffer, VertexArray, Texture, Framebuffer };
  };
  for (const mesh of meshes) await show(mesh); // the stage's own come with the first pictures
  const kept = [];
  for (const mesh of meshes) kept.push(await show(mesh));
  assert.ok(kept[0].Buffer > 5, 'buffers are counted');
  for (let i = 6; i < 30; i++) assert.deepEqual(await show(meshes[i % 3]), kept[i % 3]);
});

test('where simple light was asked for, no reflections or shadows are made, and still pictures get finer', async () => {
  const alive_when = {};
  for (const simple of [true, false]) {
    const alive = {};
    const stage = new Stage(made_up_canvas(alive), simple, { lost() {}, changed() {} });
    const { camera } = new OrbitCamera();
    const { announcement, data } = mesh_of(6, [GROUND]);
    new WorldView(announcement, data, stage).look_from(camera);
    stage.draw(camera);
    const before = { ...alive };
    await stage.complete(camera);
    stage.draw(camera);
    assert.equal(stage.lit, !simple);
    alive_when[simple] = { before, after: { ...alive } };
    assert.ok(!stage.fine);
    for (let i = 0; i < EXPOSURES; i++) stage.expose(camera);
    assert.ok(stage.fine);
  }
  assert.deepEqual(alive_when[true].after, alive_when[true].before, 'nothing is made');
  const { before, after } = alive_when[false];
  assert.deepEqual(before, alive_when[true].before, 'the first picture is the same');
  for (const kind of ['Texture', 'Framebuffer', 'Program']) assert.ok(after[kind] > before[kind], kind);
});

test('the ring on the cloth keeps what it had when it was first seen, wherever it goes', () => {
  const alive = {};
  const stage = new Stage(made_up_canvas(alive), false, { lost() {}, changed() {} });
  const { camera } = new OrbitCamera();
  const { announcement, data } = mesh_of(6, [GROUND]);
  const world = new WorldView(announcement, data, stage);
  const reticle = new Reticle();
  stage.scene.add(reticle.group);
  const show = (triangle) => {
    const centre = triangle === null ? null : { triangle, barycentric: [0.3, 0.3, 0.4] };
    reticle.update(centre, 0.05, world, camera, { width: 64, height: 48 });
    stage.draw(camera);
    const { Buffer, VertexArray } = alive;
    return { Buffer, VertexArray };
  };
  const without = show(null);
  const first = show(3);
  assert.deepEqual(first, { Buffer: without.Buffer + 8, VertexArray: without.VertexArray + 2 });
  for (const triangle of [null, 7, 20, null, 41, 3]) assert.deepEqual(show(triangle), first);
});

test('hands that let go leave a few marks behind, and to take hold again makes no program', async () => {
  const alive = {};
  const made = {};
  const stage = new Stage(made_up_canvas(alive, made), false, { lost() {}, changed() {} });
  const orbit = new OrbitCamera();
  orbit.update(1); // towards where the hands are
  const { camera } = orbit;
  const { announcement, data } = mesh_of(6, [GROUND]);
  const world = new WorldView(announcement, data, stage);
  const hands = new Hands({ append() {} });
  stage.scene.add(hands.group);
  const hand = (key) => ({ key, id: 1, name: '', color: '#aa3333', held: [0.5, 1, 0.5], target: [0.5, 1.2, 0.5],
    own: true, finger: false, hidden: false, force: 1 });
  const show = (...keys) => {
    hands.update(keys.map(hand), camera, 64, 48);
    world.look_from(camera);
    stage.draw(camera);
    const { Buffer, VertexArray } = alive;
    return { Buffer, VertexArray, programs: made.Program };
  };
  for (const lit of [false, true]) {
    if (lit) await stage.complete(camera);
    const without = show();
    const first = show('first');
    if (!lit) assert.ok(first.Buffer >= without.Buffer + 12, 'its line and its two dots are drawn');
    for (let time = 0; time < 3; time++) {
      assert.deepEqual(show(), first); // the mark is kept for the next one
      assert.deepEqual(show(`hand ${time}`), first);
    }
    const many = Array.from({ length: 20 }, (_, k) => `many ${k}`);
    show(...many);
    const after = show();
    assert.equal(after.Buffer, lit ? first.Buffer : first.Buffer + 3 * 12, 'marks of four hands are kept');
    show(...many);
    assert.deepEqual(show(), after);
    assert.equal(after.programs, first.programs);
  }
});

test('the programs of a hand are there before it takes hold', async () => {
  for (const simple of [true, false]) {
    const made = {};
    const stage = new Stage(made_up_canvas({}, made), simple, { lost() {}, changed() {} });
    const orbit = new OrbitCamera();
    orbit.update(1);
    const hands = new Hands({ append() {} });
    stage.scene.add(hands.group);
    const draw = (...shown) => {
      hands.update(shown, orbit.camera, 64, 48);
      stage.draw(orbit.camera);
      return made.Program;
    };
    draw();
    await stage.complete(orbit.camera);
    const before = draw();
    const hand = { key: 'own', id: 1, name: '', color: '#aa3333', held: [0.5, 1, 0.5], target: [0.5, 1.2, 0.5] };
    assert.equal(draw({ ...hand, own: true, finger: false, hidden: false, force: 1 }), before);
  }
});

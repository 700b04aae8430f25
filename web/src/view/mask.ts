import { Color, DoubleSide, MeshBasicMaterial, WebGLRenderTarget } from 'three';
import type { Camera, Group, LineSegments, Material, Mesh, Object3D, Scene, WebGLRenderer } from 'three';

/**
 * For each pixel, row by row from the top, the number of the cloth that is the nearest of cloths and
 * objects, from 1 on; 0 where there is none. It tells what is drawn where, whatever its colour.
 * @param parts groups of the scene; of the cloths, each child is one
 */
export function cloth_mask(
  renderer: WebGLRenderer,
  scene: Scene,
  camera: Camera,
  parts: { cloth: Group; objects: Group },
  { width, height }: { width: number; height: number },
): Uint8Array {
  const target = new WebGLRenderTarget(width, height);
  const cloths = [...parts.cloth.children] as Mesh[];
  const objects: Mesh[] = [];
  const lines: Object3D[] = []; // along edges
  parts.objects.traverse((each) => {
    if ((each as Mesh).isMesh) objects.push(each as Mesh);
    else if ((each as LineSegments).isLineSegments) lines.push(each);
  });
  const shown = scene.children.filter((child) => child.visible);
  const wanted = new Set<Object3D>([parts.cloth, parts.objects]);
  const undo = [
    ...objects.map((mesh) => flat(mesh, 0)),
    ...cloths.map((mesh, k) => flat(mesh, k + 1)),
  ];
  for (const child of shown) child.visible = wanted.has(child);
  for (const line of lines) line.visible = false;
  const { autoUpdate } = renderer.shadowMap;
  renderer.shadowMap.autoUpdate = false;
  renderer.setRenderTarget(target);
  renderer.clear();
  renderer.render(scene, camera);
  const pixels = new Uint8Array(width * height * 4);
  renderer.readRenderTargetPixels(target, 0, 0, width, height, pixels);
  renderer.setRenderTarget(null);
  renderer.shadowMap.autoUpdate = autoUpdate;
  for (const child of [...shown, ...lines]) child.visible = true;
  for (const act of undo) act();
  target.dispose();
  return Uint8Array.from({ length: width * height }, (_, pixel) => {
    const row = height - 1 - Math.floor(pixel / width);
    return pixels[(row * width + (pixel % width)) * 4];
  });
}

/** Draws a mesh in one colour, the number as its red part; returns what undoes it. */
function flat(mesh: Mesh, number: number): () => void {
  const before: Material | Material[] = mesh.material;
  const color = new Color(number / 255, 0, 0);
  const material = new MeshBasicMaterial({ color, side: DoubleSide });
  mesh.material = material;
  return () => {
    mesh.material = before;
    material.dispose();
  };
}

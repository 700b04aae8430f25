import {
  BackSide,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  PMREMGenerator,
  Scene,
  SphereGeometry,
} from 'three';
import type { WebGLRenderer } from 'three';

/** Light from large bright panels in a dim room, for soft reflections. */
export function soft_boxes(renderer: WebGLRenderer) {
  const room = new Scene();
  const shell = new SphereGeometry(10, 24, 12);
  room.add(new Mesh(shell, new MeshBasicMaterial({ color: '#a9a6a2', side: BackSide })));
  const panels: [number, number, number, number][] = [
    [-6, 5, 5, 6],
    [7, 3, 2, 2.5],
    [0, 8, -3, 4],
  ];
  for (const [x, y, z, strength] of panels) {
    const panel = new Mesh(new PlaneGeometry(5, 5), new MeshBasicMaterial());
    panel.material.color.setScalar(strength);
    panel.position.set(x, y, z);
    panel.lookAt(0, 0, 0);
    room.add(panel);
  }
  const generator = new PMREMGenerator(renderer);
  const texture = generator.fromScene(room, 0.03).texture;
  generator.dispose();
  return texture;
}

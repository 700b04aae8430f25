import { EdgesGeometry, LineBasicMaterial, LineSegments, MeshStandardMaterial } from 'three';
import type { BufferGeometry } from 'three';
import type { Collider } from '../../../proto/js/messages.js';

const JAW = /^gripper\./; // names of a gripper's jaws
const SHARP = 40; // angle at which an edge is drawn [degrees]

/**
 * What objects look like: greys of middle brightness, which neither a light nor a dark floor
 * swallows and no cloth is mistaken for; boards and tables are warmer, and jaws dark metal.
 */
export class ObjectLook {
  private round = new MeshStandardMaterial({ color: '#8d949c', roughness: 0.62 });
  private board = new MeshStandardMaterial({ color: '#a3988a', roughness: 0.75 });
  private jaw = new MeshStandardMaterial({ color: '#3d4248', roughness: 0.42, metalness: 0.35 });
  private edge = new LineBasicMaterial({ color: '#4d5157', transparent: true, opacity: 0.55 });

  material_of({ kind, name }: Collider): MeshStandardMaterial {
    if (JAW.test(name)) return this.jaw;
    return kind === 'box' ? this.board : this.round;
  }

  /** Lines along the sharp edges of a box, which its faces may not show; none for other shapes. */
  edges_of({ kind }: Collider, geometry: BufferGeometry): LineSegments | null {
    if (kind !== 'box') return null;
    const lines = new LineSegments(new EdgesGeometry(geometry, SHARP), this.edge);
    lines.raycast = () => {}; // the object is what is pointed at
    return lines;
  }

  dispose(): void {
    for (const material of [this.round, this.board, this.jaw, this.edge]) material.dispose();
  }
}

import { Color, Group, Mesh, MeshBasicMaterial, SphereGeometry, Vector3 } from 'three';
import type { PerspectiveCamera } from 'three';
import { Line2 } from 'three/examples/jsm/lines/Line2.js';
import { LineGeometry } from 'three/examples/jsm/lines/LineGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import type { Grab, Vec3, Viewer } from '../../../proto/js/messages.js';

export const NO_COLOR = '#5c6068'; // of an unknown viewer
const LINE_WIDTH = 2.5; // [pixels]
const DOT_RADIUS = 4.5; // [pixels]
const TARGET_RADIUS = 6.5; // [pixels]
const LABEL_OFFSET = 14; // [pixels]

/** A hand that holds the cloth, as drawn. */
export interface Hand {
  /** Identifies a hand: the room's number, or 0 for the own hand before the server has sent it. */
  id: number;
  name: string;
  color: string;
  held: Vec3;
  target: Vec3;
  /** The own hand needs no name. */
  own: boolean;
}

/** The owner of another viewer's hand. */
export function owner_of({ id, viewer }: Grab, who: Viewer | undefined) {
  const name = who?.name ?? (viewer ? `viewer ${viewer}` : 'scene');
  return { id, name, color: who?.color ?? NO_COLOR, own: false };
}

/** Lines from held points to their targets, labelled with the hands' owners. */
export class Hands {
  readonly group = new Group();
  private marks = new Map<string, HandMark>();
  shown: Hand[] = [];

  constructor(private labels: HTMLElement) {}

  update(hands: Hand[], camera: PerspectiveCamera, width: number, height: number): void {
    this.shown = hands;
    const key = (hand: Hand) => (hand.own ? 'own' : String(hand.id));
    const present = new Set(hands.map(key));
    for (const [name, mark] of this.marks) {
      if (present.has(name)) continue;
      mark.dispose();
      this.marks.delete(name);
    }
    for (const hand of hands) {
      let mark = this.marks.get(key(hand));
      if (!mark) {
        mark = new HandMark(hand.own ? null : this.labels);
        this.marks.set(key(hand), mark);
        this.group.add(mark.group);
      }
      mark.update(hand, camera, width, height);
    }
  }
}

class HandMark {
  readonly group = new Group();
  private line_geometry = new LineGeometry();
  private line_material = new LineMaterial({
    linewidth: LINE_WIDTH,
    depthTest: false,
    transparent: true,
    opacity: 0.92,
  });
  private material = new MeshBasicMaterial({ depthTest: false, transparent: true });
  private rim_material = new MeshBasicMaterial({ depthTest: false, transparent: true });
  private sphere = new SphereGeometry(1, 20, 12);
  private held = this.dot();
  private target = this.dot();
  private label: HTMLElement | null = null;

  constructor(labels: HTMLElement | null) {
    const line = new Line2(this.line_geometry, this.line_material);
    line.frustumCulled = false;
    line.renderOrder = 20;
    this.group.add(line);
    if (!labels) return;
    this.label = document.createElement('span');
    this.label.className = 'name';
    labels.append(this.label);
  }

  update(hand: Hand, camera: PerspectiveCamera, width: number, height: number): void {
    this.line_geometry.setPositions([...hand.held, ...hand.target]);
    this.line_material.color = new Color(hand.color);
    this.line_material.resolution.set(width, height);
    this.material.color = this.line_material.color;
    scale_to_pixels(this.held, hand.held, DOT_RADIUS, camera, height);
    scale_to_pixels(this.target, hand.target, TARGET_RADIUS, camera, height);
    if (this.label) place_label(this.label, hand, camera, width, height);
  }

  dispose(): void {
    this.group.removeFromParent();
    this.label?.remove();
    this.sphere.dispose();
    this.line_geometry.dispose();
    for (const material of [this.line_material, this.material, this.rim_material]) {
      material.dispose();
    }
  }

  /** A dot with a white rim, visible on cloth of the same colour. */
  private dot(): Group {
    const rim = new Mesh(this.sphere, this.rim_material);
    rim.renderOrder = 21;
    const core = new Mesh(this.sphere, this.material);
    core.scale.setScalar(0.72);
    core.renderOrder = 22;
    const dot = new Group().add(rim, core);
    this.group.add(dot);
    return dot;
  }
}

/** Positions an object and scales it to a size in pixels. */
export function scale_to_pixels(
  object: { position: Vector3; scale: Vector3 },
  place: Vec3,
  pixels: number,
  camera: PerspectiveCamera,
  height: number,
): void {
  object.position.set(...place);
  const depth = object.position.clone().applyMatrix4(camera.matrixWorldInverse).z;
  const height_there = 2 * Math.abs(depth) * Math.tan((camera.fov * Math.PI) / 360);
  object.scale.setScalar((pixels * height_there) / height);
}

function place_label(
  label: HTMLElement,
  hand: Hand,
  camera: PerspectiveCamera,
  width: number,
  height: number,
): void {
  const point = new Vector3(...hand.target).project(camera);
  label.textContent = hand.name;
  label.style.setProperty('--color', hand.color);
  label.hidden = Math.abs(point.z) > 1;
  const x = ((point.x + 1) / 2) * width + LABEL_OFFSET;
  const y = ((1 - point.y) / 2) * height;
  label.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translateY(-50%)`;
}

import type { PerspectiveCamera } from 'three';
import type { WeftClient } from '../../proto/js/index.js';
import type { Grab, Vec3, Viewer } from '../../proto/js/messages.js';
import { PeoplePanel } from './panel/people.js';
import type { OrbitCamera } from './view/camera.js';
import { Cursors } from './view/cursors.js';
import type { Director } from './view/director.js';
import { pose_of_camera } from './view/framing.js';
import type { Labels } from './view/labels.js';
import { Company } from './wire/company.js';

/** What the crowd reaches for, and where it reports to. */
interface Surroundings {
  client: WeftClient;
  orbit: OrbitCamera;
  director: Director;
  viewer(id: number): Viewer | undefined;
  grabs(): Grab[];
  tell(text: string): void;
  changed(): void;
}

/** The others in the room: what they point at, by whose camera this viewer sees, and their list. */
export class Crowd {
  readonly cursors: Cursors;
  readonly company: Company;
  private panel: PeoplePanel;

  constructor(
    private labels: Labels,
    private around: Surroundings,
  ) {
    const { client, orbit, director, tell } = around;
    this.cursors = new Cursors(labels);
    this.company = new Company(client, {
      see: (camera) => {
        director.leave();
        orbit.look(pose_of_camera(camera), false);
      },
      changed: () => {
        this.panel.show();
        around.changed();
      },
    });
    this.panel = new PeoplePanel(client, this.company, tell);
  }

  /** The viewer has taken the camera into its own hand, and keeps it. */
  leave(): void {
    this.around.director.leave();
    this.company.leave();
  }

  draw(camera: PerspectiveCamera, { width, height }: { width: number; height: number }): void {
    this.cursors.update(this.pointing(), camera, height);
    this.labels.arrange(width, height); // those of hands too
  }

  /** What others point at who do not hold the cloth: their hands show that. */
  private pointing(): { viewer: number; place: Vec3; name: string; color: string }[] {
    const holds = new Set(this.around.grabs().map(({ viewer }) => viewer));
    return this.company.shown.flatMap(({ viewer, place }) => {
      const one = this.around.viewer(viewer);
      return one && !holds.has(viewer) ? [{ viewer, place, name: one.name, color: one.color }] : [];
    });
  }
}

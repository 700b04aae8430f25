import { element } from './element.js';
import type { SceneDialog } from './scene_dialog.js';
import type { Scene } from './scene_groups.js';
import { title_of } from './scene_title.js';

/** The button that names the scene, and opens the dialog of all scenes. */
export class SceneList {
  private button = element<HTMLButtonElement>('scene');
  private dialog: Promise<SceneDialog> | null = null; // loaded when it is first opened
  private scenes: Scene[] = [];
  private untold = this.button.title; // of a scene that the server does not list
  private shown = '';

  /** @param load called with a chosen scene */
  constructor(private load: (scene: string) => void) {
    this.button.addEventListener('click', () => void this.open());
  }

  async open(): Promise<void> {
    if (this.button.disabled) return;
    this.dialog ??= import('./scene_dialog.js').then(async ({ SceneDialog, styles }) => {
      await styles();
      return new SceneDialog(title_of, this.load);
    });
    try {
      (await this.dialog).open(this.scenes, this.shown);
    } catch {
      this.dialog = null; // the server is away; the next press tries again
    }
  }

  /** Marks the current scene, chosen by any viewer. */
  choose(scene: string): void {
    if (this.shown === scene) return;
    this.shown = scene;
    this.name();
  }

  /** Requests the list of scenes from the server. */
  async fetch(): Promise<void> {
    try {
      const response = await fetch('api/v1/scenes');
      if (!response.ok) return;
      this.scenes = ((await response.json()) as { scenes: Scene[] }).scenes;
      this.name();
    } catch {
      // The connection was lost again; its return repeats the request.
    }
  }

  private name(): void {
    element('scene-title').textContent = title_of(this.shown);
    const described = this.scenes.find(({ name }) => name === this.shown);
    this.button.title = described?.description ?? this.untold;
    void this.dialog?.then((dialog) => dialog.show(this.scenes, this.shown));
  }
}

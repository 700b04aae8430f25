import { element } from './element.js';

interface Scene {
  name: string;
  /** One sentence on what to look at. */
  description: string;
}

/**
 * The server's scenes with their descriptions, in a dialog behind a button that names the current
 * one.
 */
export class SceneList {
  private button = element<HTMLButtonElement>('scene');
  private dialog = element<HTMLDialogElement>('scenes');
  private list = element('scene-list');
  private scenes: Scene[] = [];
  private shown = '';

  /** @param load called with a chosen scene */
  constructor(private load: (scene: string) => void) {
    this.button.addEventListener('click', () => this.open());
    this.dialog.addEventListener('click', ({ target }) => target === this.dialog && this.dialog.close());
  }

  open(): void {
    if (!this.button.disabled && !this.dialog.open) this.dialog.showModal();
  }

  /** Marks the current scene, chosen by any viewer. */
  choose(scene: string): void {
    if (this.shown === scene) return;
    this.shown = scene;
    this.write();
  }

  /** Requests the list of scenes from the server. */
  async fetch(): Promise<void> {
    try {
      const response = await fetch('api/v1/scenes');
      if (!response.ok) return;
      this.scenes = ((await response.json()) as { scenes: Scene[] }).scenes;
      this.write();
    } catch {
      // The connection was lost again; its return repeats the request.
    }
  }

  private write(): void {
    element('scene-title').textContent = title_of(this.shown);
    const described = this.scenes.find(({ name }) => name === this.shown);
    if (described) this.button.title = described.description;
    this.list.replaceChildren(...this.scenes.map((scene) => this.entry(scene)));
  }

  private entry({ name, description }: Scene): HTMLElement {
    const choice = document.createElement('button');
    choice.type = 'button';
    choice.append(text_element('b', title_of(name)), text_element('span', description));
    if (name === this.shown) choice.setAttribute('aria-current', 'true');
    choice.addEventListener('click', () => {
      this.dialog.close();
      this.load(name);
    });
    const item = document.createElement('li');
    item.append(choice);
    return item;
  }
}

function text_element(tag: string, text: string): HTMLElement {
  const made = document.createElement(tag);
  made.textContent = text;
  return made;
}

/** A scene's name as a title. */
export function title_of(name: string): string {
  const words = name.replaceAll('-', ' ');
  return words.charAt(0).toUpperCase() + words.slice(1);
}

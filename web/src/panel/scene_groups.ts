/** A scene of the server. */
export interface Scene {
  name: string;
  /** One sentence on what to look at. */
  description: string;
}

export interface Group {
  title: string;
  scenes: Scene[];
}

const EVERYDAY = 'Everyday';
// In the order in which they are shown; the first that takes a name has it.
const GROUPS: [string, RegExp][] = [
  ['Laboratory', /-test$/],
  ['Hard cases', /^hard-/],
  ['The seed’s paper', /^seed-/],
  ['Fabrics', /^(two-flags|.*fabrics?.*|silk.*|denim.*|wool.*|leather.*|nylon.*)$/],
  ['Hands and machines', /^(fan|turntable|lift-.*|gripper.*)$/],
  [EVERYDAY, /./],
];
const ORDER = [EVERYDAY, 'Fabrics', 'Hands and machines', 'Laboratory', 'The seed’s paper', 'Hard cases'];

/** Whether each word of a search begins a word of the scene's title or description. */
export function matches({ name, description }: Scene, search: string): boolean {
  const words = (text: string) => text.toLowerCase().split(/[^\p{L}\p{N}]+/u).filter(Boolean);
  const known = words(`${name} ${description}`);
  return words(search).every((asked) => known.some((word) => word.startsWith(asked)));
}

/** The scenes that match a search, in groups that are not empty. */
export function grouped(scenes: Scene[], search = ''): Group[] {
  const found = scenes.filter((scene) => matches(scene, search));
  const group_of = ({ name }: Scene) => GROUPS.find(([, names]) => names.test(name))![0];
  return ORDER.map((title) => ({
    title,
    scenes: found.filter((scene) => group_of(scene) === title),
  })).filter(({ scenes: members }) => members.length > 0);
}

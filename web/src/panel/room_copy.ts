import type { WeftClient } from '../../../proto/js/index.js';

// Copies of a room: no part of the page's first load, of which it imports nothing.

const MOST_RACES = 40; // names that other viewers take first, before no copy is made

/** A copy of a room, with the token by which its maker operates it, if that takes one. */
export interface RoomCopy {
  name: string;
  token?: string;
}

/** Makes a copy of the room that the viewer is in, by the first name that no other room has. */
export async function fork_room(client: WeftClient): Promise<RoomCopy> {
  const { rooms } = await client.listRooms();
  const taken = new Set(rooms.map(({ name }) => name));
  for (const name of copy_names(client.options.name ?? client.welcome?.name ?? '')) {
    if (taken.has(name)) continue;
    try {
      const { token } = await client.fork(name);
      return { name, token };
    } catch (error) {
      // Another viewer has just taken it.
      const again = error instanceof Error && 'code' in error && error.code === 'room_exists';
      if (!again || taken.size > rooms.length + MOST_RACES) throw error;
      taken.add(name);
    }
  }
  throw new Error('names do not end');
}

/** Names for a copy of a room that a viewer makes, the best first, without end. */
export function* copy_names(viewer: string): Generator<string> {
  const letters = viewer.normalize('NFKD').replace(/\p{M}/gu, '').toLowerCase();
  const name = letters.replace(/[^a-z0-9]+/g, '-').replace(/^-+|-+$/g, '').slice(0, 24).replace(/-+$/, '');
  const base = name || 'copy';
  if (base !== 'default') yield base; // the name of the first room
  for (let k = 2; ; k++) yield `${base}-${k}`;
}

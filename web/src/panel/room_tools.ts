import type { MeshAnnouncement } from '../../../proto/js/messages.js';
import { back_of, colors_of } from '../view/looks.js';
import { smooth_normals } from '../view/normals.js';
import { glance_at, glance_on, tell_refusal } from '../wire/connection.js';
import { FIRST_ROOM, own_room } from '../wire/own_address.js';
import { crossings_text, guarantee_text } from './guarantee.js';
import { title_of } from './scene_title.js';

/** What the page has already, so that the list of rooms and the wall stay small. */
export const room_tools = {
  FIRST_ROOM,
  own_room,
  title_of,
  crossings_text,
  guarantee_text,
  tell_refusal,
  glance_at,
  glance_on,
  smooth_normals,
  cloth_colors({ cloths }: MeshAnnouncement): { front: string; back: string }[] {
    return colors_of(cloths.map(({ look }) => look)).map((color, k) => ({
      front: `#${color.getHexString()}`,
      back: `#${back_of(cloths[k].look, color).getHexString()}`,
    }));
  },
};

export type RoomTools = typeof room_tools & {
  /** Goes to a room. */
  go(room: string): void;
};

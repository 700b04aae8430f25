/** The room that is always there. */
export const FIRST_ROOM = 'default';

/** The room that the page's address names in its fragment, as `#room=ada`; the first one, if it names none. */
export function own_room(): string {
  return fragment().get('room') || FIRST_ROOM;
}

/** The token that the page's address carries in its fragment, which no browser sends in a request; may be empty. */
export function own_token(): string {
  return fragment().get('token') ?? '';
}

/** The page's address in a room; the token stays in it unless there is another one. */
export function address_in(room: string, token?: string): string {
  const parts = fragment();
  parts.delete('room');
  if (token) parts.set('token', token);
  if (room !== FIRST_ROOM) parts.set('room', room);
  const url = new URL(window.location.href);
  url.hash = parts.toString();
  return url.href;
}

/** The page's address, room and all, with another token. */
export function link_with(token: string): string {
  const url = new URL(address_in(own_room(), token));
  for (const own of ['name', 'light']) url.searchParams.delete(own); // of this person and this machine
  return url.href;
}

/** The address of a room's socket, on the server that the page came from. */
export function socket_of(room: string): string {
  const path = room === FIRST_ROOM ? 'ws' : `ws/${encodeURIComponent(room)}`;
  const url = new URL(path, window.location.href);
  url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
  url.search = url.hash = '';
  return url.href;
}

function fragment(): URLSearchParams {
  return new URLSearchParams(window.location.hash.slice(1));
}

const SOCKETS = new Map([['http:', 'ws:'], ['https:', 'wss:'], ['ws:', 'ws:'], ['wss:', 'wss:']]);

/**
 * The token that a link to the page tells in its fragment, `#token=…`.
 * @param {string} link  that is an address
 */
export function tokenOf(link) {
  return new URLSearchParams(new URL(link).hash.slice(1)).get('token') ?? undefined;
}

/**
 * The address of a server's socket; `given` may be that of its page, with `#room=…` for a room.
 * @param {string} given
 * @param {'socket' | 'http'} [mesh]  where the mesh is to come from
 */
export function socketAddress(given, mesh) {
  const wanted = 'give one as ws://127.0.0.1:8080/ws, or that of its page';
  let url;
  try {
    url = new URL(given);
  } catch (cause) {
    throw new TypeError(`'${given}' is no address: ${wanted}`, { cause });
  }
  const protocol = SOCKETS.get(url.protocol);
  if (!protocol) throw new TypeError(`'${given}' is no address of a server: ${wanted}`);
  const room = new URLSearchParams(url.hash.slice(1)).get('room'); // as the page's links name it
  url.protocol = protocol;
  url.hash = '';
  if (url.pathname === '/') url.pathname = '/ws';
  if (room && url.pathname === '/ws') url.pathname = `/ws/${encodeURIComponent(room)}`;
  if (mesh === 'http') url.searchParams.set('mesh', 'http');
  return url;
}

/** The token that the page's address carries in its fragment, which no browser sends in a request; may be empty. */
export function own_token(): string {
  return new URLSearchParams(window.location.hash.slice(1)).get('token') ?? '';
}

/** The page's address, room and all, with another token. */
export function link_with(token: string): string {
  const url = new URL(window.location.href);
  for (const own of ['name', 'light']) url.searchParams.delete(own); // of this person and this machine
  const room = new URLSearchParams(url.hash.slice(1)).get('room');
  url.hash = new URLSearchParams({ token, ...(room ? { room } : {}) }).toString();
  return url.href;
}

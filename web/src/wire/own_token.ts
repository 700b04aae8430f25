/** The token that the page's address carries in its fragment, which no browser sends in a request; may be empty. */
export function own_token(): string {
  return new URLSearchParams(window.location.hash.slice(1)).get('token') ?? '';
}

/** The page's address with another token. */
export function link_with(token: string): string {
  const url = new URL(window.location.href);
  for (const own of ['name', 'light']) url.searchParams.delete(own); // of this person and this machine
  url.hash = `token=${token}`;
  return url.href;
}

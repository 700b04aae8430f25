const sheets = new Map<string, Promise<void>>();

/** Loads styles that are no part of the first load; once, unless they did not come. */
export function late_styles(href: string): Promise<void> {
  const known = sheets.get(href);
  if (known) return known;
  const link = Object.assign(document.createElement('link'), { rel: 'stylesheet', href });
  const loaded = new Promise<void>((done, fail) => {
    link.addEventListener('load', () => done());
    link.addEventListener('error', () => {
      sheets.delete(href);
      fail(new Error(`${href} did not come`));
    });
  });
  sheets.set(href, loaded);
  document.head.append(link);
  return loaded;
}

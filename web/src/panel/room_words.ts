/** Writes a text if it is another, so that nothing is laid out anew for the same words. */
export function write(element: HTMLElement, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

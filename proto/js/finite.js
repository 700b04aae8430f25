/**
 * JSON would make `null` of a number that is not finite, and the server would take that as absent.
 * @param {unknown} value
 * @param {string} path  of it, for the error
 */
export function requireFinite(value, path) {
  if (typeof value === 'number' && !Number.isFinite(value))
    throw new RangeError(`${path} = ${value}: numbers have to be finite`);
  if (typeof value !== 'object' || value === null) return;
  for (const [key, inner] of Object.entries(value))
    requireFinite(inner, Array.isArray(value) ? `${path}[${key}]` : `${path}.${key}`);
}

import { FIELDS } from './fields.js';

/**
 * The fields of a command, or a TypeError that names one that it has not: the server ignores what it
 * does not know, so that a misspelt field would do nothing.
 * @template {object} Fields
 * @param {string} what  the command, or the kind of a part of it
 * @param {Fields} fields
 * @returns {Fields}
 */
export function known(what, fields) {
  const names = FIELDS[what];
  for (const [name, value] of Object.entries(fields)) {
    if (!names.includes(name))
      throw new TypeError(`${what} has no field '${name}'; it has ${names.join(', ')}`);
    if (name === 'fabric' && value) known('fabric', value);
    if (name === 'fans') for (const fan of value ?? []) known('fans', fan);
  }
  return fields;
}

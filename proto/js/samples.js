// Written by proto/generate.py from proto/frames. Do not edit.

import { readArray, readList, readNumber, readPlace, readVector, readWord } from './entries.js';

/**
 * What a frame has beside times and positions.
 * @param {number} flags
 * @param {DataView} view
 * @param {import('./entries.js').Find} find  a section of this kind
 * @param {number} vertices
 * @returns {import('./frame_parts.js').FrameParts}
 */
export function readParts(flags, view, find, vertices) {
  return {
    flags,
    key: (flags & 1) !== 0,
    jump: (flags & 2) !== 0,
    paused: (flags & 4) !== 0,
    observed: (flags & 8) !== 0,
    grabs: readList(find(2), 36, (at) => ({
      id: view.getUint32(at, true),
      viewer: view.getUint32(at + 4, true),
      held: readVector(view, at + 8, 3),
      target: readVector(view, at + 20, 3),
      force: readNumber(view, at + 32),
    })),
    applied: readList(find(3), 8, (at) => ({
      viewer: view.getUint32(at, true),
      number: view.getUint32(at + 4, true),
    })),
    poses: readList(find(4), 32, (at) => ({
      collider: view.getUint32(at, true),
      position: readVector(view, at + 4, 3),
      rotation: readVector(view, at + 16, 4),
    })),
    contacts: readList(find(5), 52, (at) => ({
      collider: readPlace(view, at, 4294967295),
      particle: view.getUint32(at + 4, true),
      point: readVector(view, at + 8, 3),
      normal: readVector(view, at + 20, 3),
      gap: readNumber(view, at + 32),
      normalForce: readNumber(view, at + 36),
      friction: readVector(view, at + 40, 3),
    })),
    reactions: readList(find(6), 20, (at) => ({
      of: readWord(view, at, ['pin', 'collider']),
      id: view.getUint32(at + 4, true),
      force: readVector(view, at + 8, 3),
    })),
    grippers: readList(find(9), 68, (at) => ({
      jaw: view.getUint32(at, true),
      gripping: view.getUint32(at + 4, true) !== 0,
      position: readVector(view, at + 8, 3),
      rotation: readVector(view, at + 20, 4),
      opening: readNumber(view, at + 36),
      force: readNumber(view, at + 40),
      reaction: readVector(view, at + 44, 3),
      torque: readVector(view, at + 56, 3),
    })),
    velocities: readArray(view, find(8), vertices * 3),
  };
}

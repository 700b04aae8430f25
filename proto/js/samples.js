// Lists in the sections of a frame (proto/README.md section 6).

import { demand, demandFinite } from './bytes.js';

/** @typedef {import('./bytes.js').Section} Section */

const GRAB_BYTES = 36;
const APPLIED_BYTES = 8;
const POSE_BYTES = 32;
const CONTACT_BYTES = 52;
const REACTION_BYTES = 20;
const GRIPPER_BYTES = 68;
const NO_COLLIDER = 0xffffffff;
/** @type {('pin' | 'collider')[]} */
const REACTION_OF = ['pin', 'collider'];

/**
 * @param {DataView} view
 * @param {Section} section
 */
export function readGrabs(view, section) {
  demand(section.length % GRAB_BYTES === 0, 'a section does not fit');
  const grabs = [];
  for (let at = section.offset; at < section.offset + section.length; at += GRAB_BYTES) {
    const numbers = new Float32Array(view.buffer, view.byteOffset + at + 8, 7);
    demandFinite(numbers);
    const [hx, hy, hz, tx, ty, tz, force] = numbers;
    grabs.push({
      id: view.getUint32(at, true),
      viewer: view.getUint32(at + 4, true),
      held: [hx, hy, hz],
      target: [tx, ty, tz],
      force,
    });
  }
  return grabs;
}

/**
 * @param {DataView} view
 * @param {Section} section
 */
export function readApplied(view, section) {
  demand(section.length % APPLIED_BYTES === 0, 'a section does not fit');
  const applied = [];
  for (let at = section.offset; at < section.offset + section.length; at += APPLIED_BYTES)
    applied.push({ viewer: view.getUint32(at, true), number: view.getUint32(at + 4, true) });
  return applied;
}

/**
 * @param {DataView} view
 * @param {Section} section
 */
export function readPoses(view, section) {
  demand(section.length % POSE_BYTES === 0, 'a section does not fit');
  const poses = [];
  for (let at = section.offset; at < section.offset + section.length; at += POSE_BYTES) {
    const numbers = new Float32Array(view.buffer, view.byteOffset + at + 4, 7);
    demandFinite(numbers);
    const [x, y, z, ...rotation] = numbers;
    poses.push({ collider: view.getUint32(at, true), position: [x, y, z], rotation });
  }
  return poses;
}

/**
 * @param {DataView} view
 * @param {Section} section
 */
export function readContacts(view, section) {
  demand(section.length % CONTACT_BYTES === 0, 'a section does not fit');
  const contacts = [];
  for (let at = section.offset; at < section.offset + section.length; at += CONTACT_BYTES) {
    const collider = view.getUint32(at, true);
    const numbers = new Float32Array(view.buffer, view.byteOffset + at + 8, 11);
    demandFinite(numbers);
    const all = [...numbers];
    contacts.push({
      collider: collider === NO_COLLIDER ? null : collider,
      particle: view.getUint32(at + 4, true),
      point: all.slice(0, 3),
      normal: all.slice(3, 6),
      gap: numbers[6],
      normalForce: numbers[7],
      friction: all.slice(8, 11),
    });
  }
  return contacts;
}

/**
 * @param {DataView} view
 * @param {Section} section
 */
export function readReactions(view, section) {
  demand(section.length % REACTION_BYTES === 0, 'a section does not fit');
  const reactions = [];
  for (let at = section.offset; at < section.offset + section.length; at += REACTION_BYTES) {
    const of = view.getUint32(at, true);
    const force = new Float32Array(view.buffer, view.byteOffset + at + 8, 3);
    demandFinite(force);
    reactions.push({ of: REACTION_OF[of] ?? of, id: view.getUint32(at + 4, true), force: [...force] });
  }
  return reactions;
}

/**
 * @param {DataView} view
 * @param {Section} section
 */
export function readGrippers(view, section) {
  demand(section.length % GRIPPER_BYTES === 0, 'a section does not fit');
  const grippers = [];
  for (let at = section.offset; at < section.offset + section.length; at += GRIPPER_BYTES) {
    const numbers = new Float32Array(view.buffer, view.byteOffset + at + 8, 15);
    demandFinite(numbers);
    const all = [...numbers];
    grippers.push({
      jaw: view.getUint32(at, true),
      gripping: view.getUint32(at + 4, true) !== 0,
      position: all.slice(0, 3),
      rotation: all.slice(3, 7),
      opening: all[7],
      force: all[8],
      reaction: all.slice(9, 12),
      torque: all.slice(12, 15),
    });
  }
  return grippers;
}

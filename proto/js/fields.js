// Written by proto/generate.py from the descriptions in proto/messages. Do not edit.

/** @type {Record<string, string[]>} */
export const FIELDS = {
  hello: ['name', 'color', 'token'],
  pick: ['origin', 'direction'],
  drag: [
    'phase', 'drag', 'particle', 'triangle', 'barycentric', 'mode', 'target', 'radius', 'stiffness', 'max_force',
    'fire',
  ],
  pin: ['particle', 'triangle', 'barycentric', 'radius'],
  release: ['pin', 'particle', 'all'],
  camera: ['position', 'target', 'up', 'fov'],
  step: ['n'],
  save: ['name'],
  restore: ['name'],
  speed: ['speed'],
  move: [
    'collider', 'position', 'rotation', 'speed', 'turn_speed', 'force', 'release', 'pin', 'seconds', 'max_force',
    'stop',
  ],
  gripper: ['name', 'opening', 'force', 'position', 'rotation', 'speed', 'turn_speed'],
  set: [
    'gravity', 'wind', 'gust_speed', 'gust_length', 'air_density', 'still_air', 'drag', 'fans', 'softness',
    'budget_ms', 'over_budget', 'fabric', 'cloth',
  ],
  fans: ['position', 'direction', 'speed', 'radius', 'spread', 'reach'],
  fabric: [
    'preset', 'areal_density', 'stretch_warp', 'stretch_weft', 'shear', 'poisson', 'bending_warp', 'bending_weft',
    'locking_strain', 'locking_factor', 'damping_ratio', 'stretch_damping', 'shear_damping', 'bending_damping',
    'thickness', 'friction', 'restitution', 'air_normal', 'air_tangential',
  ],
  advance: ['n', 'frames', 'observe'],
  query: ['what', 'format', 'viewer', 'tree', 'level'],
  ping: ['t'],
  load: ['scene'],
  view: ['hz', 'codec', 'error', 'forces'],
  create_room: ['name', 'scene', 'paused'],
  close_room: ['name'],
  fork: ['name', 'paused'],
  policy: ['policy'],
  mute: ['viewer', 'muted'],
  give_hand: ['viewer', 'given'],
  presence: ['cursor', 'away', 'camera'],
  follow: ['viewer'],
  lead: ['on'],
  invite: ['right'],
};

// Written by proto/generate.py from the descriptions in proto/messages. Do not edit.

import type { Vec3 } from './messages.js';
import type { Crossings, Energy, EnergyBalance, Fabric, Fan, Guarantee, Sleeping, Strain } from './parts.js';

export interface State {
  op: 'state';
  tick: number;
  /** simulated [s] */
  time: number;
  paused: boolean;
  /** who may hold the cloth; `watch` or `one_hand` or `everybody` */
  policy: 'watch' | 'one_hand' | 'everybody';
  /** simulated time per real time that was asked for */
  speed: number;
  /** fraction of `speed` at which time passes */
  pace: number;
  /** fraction of their stiffness that the springs have */
  softness: number;
  /** for each tick that is due; 0: no bound [ms] */
  budget_ms: number;
  /** what gives way beyond it; `slow` or `soften` */
  over_budget: 'slow' | 'soften';
  /** its name */
  scene: string;
  tick_rate: number;
  /** acceleration [m/s²] */
  gravity: Vec3;
  /** mean velocity [m/s] */
  wind: Vec3;
  /** bound of each component of the gusts [m/s] */
  gust_speed: number;
  /** size of an eddy [m] */
  gust_length: number;
  air_density: number;
  /** air resists without wind too; `true` or `false` */
  still_air: boolean;
  /** uniform damping of velocities [1/s] */
  drag: number;
  /** all local winds */
  fans: Fan[];
  /** names of all cloths' fabrics */
  fabric: string;
  /** of each cloth, every value; without `preset` if it is of none */
  fabrics: Fabric[];
  /** its name */
  solver: string;
  /** of the last tick */
  substeps: number;
  /** of all cloths */
  particles: number;
  /** median time of a tick [ms] */
  step_ms: number;
  /** simulated per real time that is reached */
  real_time_factor: number;
  /** cloths at rest, which are not stepped */
  sleeping: Sleeping;
  /** whether the promise holds that cloth passes through nothing */
  guarantee: Guarantee;
  /** as last counted; null before the first count */
  crossings: Crossings | null;
  /** of the springs */
  strain: Strain;
  energy: Energy;
  /** of energy; while it is measured: see the query `balance` */
  balance?: EnergyBalance;
}

export interface Notice {
  op: 'notice';
  level: 'info' | 'warning' | 'error';
  /** what has happened */
  code: string;
  /** for people */
  message: string;
  /** when */
  tick?: number;
  /** that caused it */
  viewer?: number;
  /** of `lease_expired` */
  drag?: number;
  /** of `frames_dropped` */
  count?: number;
  /** that holds now */
  value?: number;
}

export interface Bye {
  op: 'bye';
  /** the close code that follows */
  code: number;
  /** for people */
  reason: string;
}

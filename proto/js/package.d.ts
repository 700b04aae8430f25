// What the package exports: its classes and functions, and the types of all messages.

export * from './index.js';
export type { Call, Events, Options } from './session.js';
export * from './messages.js';

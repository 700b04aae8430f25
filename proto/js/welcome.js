import { CallTimeout, ConnectionLost } from './errors.js';

export const LONGEST_TIMER = 2 ** 31 - 1; // the most that timers take [ms]

/**
 * The next `welcome` of a session; rejects if it closes, or if none comes in time.
 * @param {import('./session.js').Session} session
 * @param {number} timeout  [ms]; Infinity: none
 * @returns {Promise<import('./messages.js').Welcome>}
 */
export function firstWelcome(session, timeout) {
  const { timers } = session;
  return new Promise((resolve, reject) => {
    /** @param {() => void} settle */
    const finish = (settle) => {
      for (const stop of stops) stop();
      settle();
    };
    const expire = () => finish(() => reject(new CallTimeout('connect', timeout)));
    const timer = timeout <= LONGEST_TIMER ? timers.setTimeout(expire, timeout) : null;
    const stops = [
      session.on('welcome', (message) => finish(() => resolve(message))),
      session.on('status', ({ phase, reason, code }) => {
        if (phase === 'closed') finish(() => reject(new ConnectionLost(`${code} ${reason}`)));
      }),
      () => timers.clearTimeout(timer),
    ];
  });
}

/** A frame of one vertex that moves along x with 1 m/s of the server's time. */
export function frame_at(tick, changes = {}, rate = 60) {
  const serverTime = 100 + tick / rate;
  const positions = Float32Array.of(serverTime - 100, 0, 0);
  const state = { grabs: [], poses: [], jump: false, paused: false };
  return { tick, serverTime, positions, ...state, ...changes };
}

/** Numbers in [0, 1) that are the same each time (Park and Miller). */
export function numbers(seed) {
  let state = seed;
  return () => (state = (state * 48271) % 2147483647) / 2147483647;
}

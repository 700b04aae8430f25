import { CommandError, WeftClient } from '../../../proto/js/index.js';
import { shown_name } from './names.js';
import { own_room, own_token, socket_of } from './own_address.js';
import { WorkerFrames } from './worker_frames.js';

const SHOWN_ERROR = 4e-4; // how far off a vertex may be on a slow link; 1e-4 else [m]
const GLANCES = 1; // frames per second of a small picture
const EVERY_TICK = 240; // frames per second; more than any display shows
const ASKING_LIMIT = 5000; // for the answer to a plain request [ms]
const PATIENCE = 3; // failed attempts before a proxy is suspected

/** Why the server refuses the page, and the remedy. */
export interface Refusal {
  message: string;
  hint: string;
}

const SUSPECTED_PROXY: Refusal = {
  message: 'the server answers, but its socket does not open',
  hint: 'a proxy in between has to pass WebSocket upgrades on',
};

const UNKNOWN_TOKEN: Refusal = {
  message: 'this server lets in only those who have a link',
  hint: 'open the whole link that you were given, with what follows #token=',
};
const UNKNOWN_ROOM: Refusal = {
  message: 'there is no such room any more',
  hint: 'rooms that nobody is in close after a while; the first room is always there',
};
const CLOSED_ROOM: Refusal = { ...UNKNOWN_ROOM, message: 'this room was closed' };
const REFUSALS = new Map([[4003, UNKNOWN_TOKEN], [4004, CLOSED_ROOM]]); // by close code

/** Connects to the server that the page came from. @param name of the viewer; may be empty */
export function connect_client(name: string): WeftClient {
  const token = own_token();
  const frames = new WorkerFrames(new Worker('frame_worker.js', { type: 'module' }));
  const client = new WeftClient(socket_of(own_room()), { frames, ...(name ? { name } : {}), ...(token ? { token } : {}) });
  const look = () => view_from_now(client, { hz: document.hidden ? 0 : EVERY_TICK });
  document.addEventListener('visibilitychange', look);
  client.wantedView = { codec: 'packed', error: SHOWN_ERROR, ...(document.hidden ? { hz: 0 } : {}) };
  window.addEventListener('pagehide', () => client.close());
  window.addEventListener('pageshow', ({ persisted }) => persisted && void client.connect().catch(() => {}));
  // Heard before all others, which so know no other names.
  client.on('roster', ({ viewers }) => {
    for (const viewer of viewers) viewer.name = shown_name(viewer);
  });
  client.connect().catch(() => {}); // the status reports failures
  return client;
}

/**
 * Glances at a room for a small picture of it, without being in it: a frame a second of the cloth, as coarse as the
 * server has them, and the mesh from the cache, which copies of one room share.
 */
export function glance_at(room: string): WeftClient {
  const token = own_token();
  const client = new WeftClient(`${socket_of(room)}?glance=1`, { mesh: 'http', ...(token ? { token } : {}) });
  client.wantedView = { hz: document.hidden ? 0 : GLANCES, codec: 'packed', error: SHOWN_ERROR };
  client.connect().catch(() => {}); // the room may be gone
  return client;
}

/** Asks for the present frame and those that follow, or for none. */
export function glance_on(client: WeftClient, on: boolean): void {
  view_from_now(client, { hz: on ? GLANCES : 0, codec: 'packed' });
}

/** Asks for frames, on the connections that follow too, also where there is none now. */
function view_from_now(client: WeftClient, wanted: { hz: number; codec?: 'packed' }): void {
  client.wantedView = { ...client.wantedView, ...wanted };
  client.view(wanted).catch(() => {});
}

/**
 * Reports after each failed attempt why the socket does not open; null if the reason is unknown,
 * and once it is open. Browsers hide the answer to a refused upgrade, so a plain request asks.
 */
export function explain_refusals(client: WeftClient, tell: (refusal: Refusal | null) => void): void {
  let failures = 0;
  let question = 0; // the newest; answers to others come too late
  let last: string = 'connecting'; // as left by connect_client
  client.on('status', ({ phase, code }) => {
    const failed = last === 'connecting' && phase === 'waiting';
    last = phase;
    // What is closed by the page itself is left for another room.
    if (phase === 'open' || phase === 'closed') {
      failures = 0;
      question += 1;
      tell(REFUSALS.get(code ?? 0) ?? null);
    }
    if (!failed) return;
    const asked = ++question;
    void ask_refusal(++failures >= PATIENCE).then((refusal) => {
      if (asked === question) tell(refusal);
    });
  });
}

async function ask_refusal(suspect_proxy: boolean): Promise<Refusal | null> {
  const url = new URL('api/v1/connect', window.location.href);
  url.hash = '';
  url.search = `origin=${window.location.origin}&room=${encodeURIComponent(own_room())}`;
  try {
    const signal = AbortSignal.timeout(ASKING_LIMIT);
    const answer = await fetch(url, { signal, cache: 'no-store' });
    if (answer.ok) return suspect_proxy ? SUSPECTED_PROXY : null;
    const { error } = (await answer.json()) as { error: Refusal & { code: string } };
    if (error.code === 'unknown_room') return UNKNOWN_ROOM;
    return { message: error.message, hint: error.hint ?? '' };
  } catch {
    return null; // no answer, or not from a Weft server
  }
}

/**
 * Awaits a command in the background. A refusal is reported; a lost connection is not, because the
 * connection's state shows it.
 */
export function tell_refusal(answer: Promise<unknown>, tell: (message: string) => void): void {
  answer.catch((error: unknown) => {
    if (error instanceof CommandError) tell(error.message);
  });
}

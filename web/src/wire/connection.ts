import { CommandError, WeftClient } from '../../../proto/js/index.js';
import { own_token } from './own_token.js';
import { WorkerFrames } from './worker_frames.js';

const SHOWN_ERROR = 4e-4; // how far off a vertex may be on a slow link; 1e-4 else [m]
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
const TOKEN_REFUSED = 4003; // the close code

/** Connects to the server that the page came from. @param name of the viewer; may be empty */
export function connect_client(name: string): WeftClient {
  const url = new URL('ws', window.location.href);
  url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
  url.search = url.hash = '';
  const token = own_token();
  const frames = new WorkerFrames(new Worker('frame_worker.js', { type: 'module' }));
  const client = new WeftClient(url.href, { frames, ...(name ? { name } : {}), ...(token ? { token } : {}) });
  const look = () => void client.view({ hz: document.hidden ? 0 : EVERY_TICK }).catch(() => {});
  document.addEventListener('visibilitychange', look);
  client.wantedView = { codec: 'packed', error: SHOWN_ERROR, ...(document.hidden ? { hz: 0 } : {}) };
  window.addEventListener('pagehide', () => client.close());
  window.addEventListener('pageshow', ({ persisted }) => persisted && void client.connect());
  client.connect().catch(() => {}); // the status reports failures
  return client;
}

/**
 * Reports after each failed attempt why the socket does not open; null if the reason is unknown,
 * and once it is open. Browsers hide the answer to a refused upgrade, so a plain request asks.
 */
export function explain_refusals(client: WeftClient, tell: (refusal: Refusal | null) => void): void {
  let failures = 0;
  let last: string = 'connecting'; // as left by connect_client
  client.on('status', ({ phase, code }) => {
    if (phase === 'closed' && code === TOKEN_REFUSED) return tell(UNKNOWN_TOKEN);
    const failed = last === 'connecting' && phase === 'waiting';
    last = phase;
    if (phase === 'open') {
      failures = 0;
      tell(null);
    }
    if (!failed) return;
    const attempt = ++failures;
    void ask_refusal(attempt >= PATIENCE).then((refusal) => {
      if (attempt === failures) tell(refusal);
    });
  });
}

async function ask_refusal(suspect_proxy: boolean): Promise<Refusal | null> {
  const url = new URL('api/v1/connect', window.location.href);
  url.hash = '';
  url.search = `origin=${window.location.origin}`;
  try {
    const signal = AbortSignal.timeout(ASKING_LIMIT);
    const answer = await fetch(url, { signal, cache: 'no-store' });
    if (answer.ok) return suspect_proxy ? SUSPECTED_PROXY : null;
    const { error } = (await answer.json()) as { error: Refusal };
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

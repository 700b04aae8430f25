import { CommandError, WeftClient } from '../../proto/js/index.js';

const LONGEST_NAME = 32; // of a viewer, by the wire
const EVERY_TICK = 240; // frames a second; more than any display shows

/** Connects to the server that the page came from; `?name=Ada` in its address names the viewer. */
export function connect_client(): WeftClient {
  const url = new URL('ws', window.location.href);
  url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
  url.search = url.hash = '';
  const asked = new URLSearchParams(window.location.search).get('name') ?? '';
  const name = [...asked.replace(/\p{Cc}/gu, '').trim()].slice(0, LONGEST_NAME).join('');
  const client = new WeftClient(url.href, name ? { name } : {});
  const look = () => void client.view({ hz: document.hidden ? 0 : EVERY_TICK }).catch(() => {});
  document.addEventListener('visibilitychange', look);
  if (document.hidden) client.wantedView = { hz: 0 };
  window.addEventListener('pagehide', () => client.close());
  window.addEventListener('pageshow', ({ persisted }) => persisted && void client.connect());
  client.connect().catch(() => {}); // the status tells
  return client;
}

/**
 * Waits for a command in the background; what the server refuses is told, and a lost connection is
 * not, because the connection's state shows that.
 */
export function tell_refusal(answer: Promise<unknown>, tell: (message: string) => void): void {
  answer.catch((error: unknown) => {
    if (error instanceof CommandError) tell(error.message);
  });
}

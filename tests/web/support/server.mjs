import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { createInterface } from 'node:readline';
import { WeftClient } from '../../../proto/js/index.js';
import { late_sockets } from './late.mjs';
import { require_package } from './packages.mjs';

const WebSocket = late_sockets(require_package('ws').WebSocket);
const program = process.env.WEFT_PROGRAM;
if (!program) throw new Error('WEFT_PROGRAM must name the program to test');

const LONGEST_LIFE = 600; // of a server that is given none [s]

/**
 * Starts a server on loopback that ends by itself.
 * @param {string[]} [options] of `weft serve`
 */
export async function start_server(options = [], port = 0) {
  const life = options.includes('--max-seconds') ? [] : ['--max-seconds', String(LONGEST_LIFE)];
  const process_ = spawn(
    program,
    ['serve', '--bind', '127.0.0.1', '--port', String(port), '--log-level', 'warning']
      .concat(life, options),
    { stdio: ['ignore', 'pipe', 'inherit'] },
  );
  const ended = once(process_, 'exit');
  const first_line = once(createInterface(process_.stdout), 'line').then(([line]) => line);
  const line = await Promise.race([first_line, ended.then(() => null)]);
  if (line === null) throw new Error(`${program} serve ended before it listened`);
  const addresses = JSON.parse(line);
  return {
    ...addresses,
    /** @param {NodeJS.Signals} [signal] */
    async stop(signal = 'SIGTERM') {
      process_.kill(signal);
      await ended;
    },
    /** A script that looks at the same cloth. @param options of the client */
    async script(name = 'script', options = {}) {
      const client = new WeftClient(addresses.websocket, { name, WebSocket, reconnect: false, ...options });
      const last = { pins: [], grabs: [], viewers: [] };
      client.on('pins', ({ pins }) => (last.pins = pins));
      client.on('grabs', ({ grabs }) => (last.grabs = grabs));
      await client.connect();
      return Object.assign(client, { last });
    },
  };
}

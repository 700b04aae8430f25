import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { mkdtemp, rm, writeFile } from 'node:fs/promises';
import { connect, createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';

// What may stand between a page and its server.

const nginx = fileURLToPath(new URL('../../../.tools/nginx/usr/sbin/nginx', import.meta.url));
const LONGEST_START = 30_000; // [ms]

/** A port of loopback that is free now. */
export async function free_port() {
  const probe = createServer().listen(0, '127.0.0.1');
  await once(probe, 'listening');
  const { port } = probe.address();
  probe.close();
  await once(probe, 'close');
  return port;
}

/** Passes every byte on from a port of its own to another one, as `ssh -L` does. */
export async function forward_to(port) {
  const sockets = new Set();
  const server = createServer((near) => {
    const far = connect(port, '127.0.0.1');
    for (const [from, to] of [
      [near, far],
      [far, near],
    ]) {
      sockets.add(from);
      from.on('error', () => to.destroy());
      from.on('close', () => {
        sockets.delete(from);
        to.destroy();
      });
      from.pipe(to);
    }
  }).listen(0, '127.0.0.1');
  await once(server, 'listening');
  return {
    port: server.address().port,
    async stop() {
      for (const socket of sockets) socket.destroy();
      server.close();
      await once(server, 'close');
    },
  };
}

/** Runs a program to its end. */
async function run(command, options) {
  const process_ = spawn(command, options, { stdio: ['ignore', 'ignore', 'pipe'], timeout: 60_000 });
  let told = '';
  process_.stderr.on('data', (part) => (told += part));
  const [code] = await once(process_, 'exit');
  if (code !== 0) throw new Error(`${command} ended with ${code}: ${told}`);
}

const configuration = (port, server_port, location) => `
daemon off;
master_process off;
pid nginx.pid;
error_log stderr crit;
events {}
http {
  access_log off;
  client_body_temp_path body;
  proxy_temp_path proxy;
  fastcgi_temp_path fastcgi;
  uwsgi_temp_path uwsgi;
  scgi_temp_path scgi;
  server {
    listen 127.0.0.1:${port} ssl;
    ssl_certificate certificate.pem;
    ssl_certificate_key key.pem;
    location / {
      proxy_pass http://127.0.0.1:${server_port};
      proxy_http_version 1.1;
      ${location}
    }
  }
}
`;

/** What a location needs beside `proxy_pass`. */
export const PASSES_UPGRADES = `
      proxy_set_header Host $http_host;
      proxy_set_header Upgrade $http_upgrade;
      proxy_set_header Connection "upgrade";`;

/**
 * Starts nginx with TLS and a certificate of its own before a server.
 * @param {number} server_port
 * @param {number} port of the proxy
 * @param {string} location lines of the location
 */
export async function start_proxy(server_port, port, location) {
  const folder = await mkdtemp(join(tmpdir(), 'weft_nginx_'));
  await run('openssl', [
    ...['req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:prime256v1', '-nodes'],
    ...['-days', '2', '-subj', '/CN=weft.example', '-addext', 'subjectAltName=DNS:weft.example'],
    ...['-keyout', join(folder, 'key.pem'), '-out', join(folder, 'certificate.pem')],
  ]);
  await writeFile(join(folder, 'nginx.conf'), configuration(port, server_port, location));
  const process_ = spawn(nginx, ['-p', folder, '-c', 'nginx.conf', '-e', 'stderr'], {
    stdio: ['ignore', 'ignore', 'inherit'],
    timeout: 600_000,
  });
  const ended = Promise.race([once(process_, 'exit'), once(process_, 'error')]);
  await until_open(port, process_);
  return {
    async stop() {
      process_.kill('SIGTERM');
      await ended;
      await rm(folder, { recursive: true });
    },
  };
}

async function until_open(port, process_) {
  const end = Date.now() + LONGEST_START;
  while (Date.now() < end && process_.exitCode === null) {
    const socket = connect(port, '127.0.0.1');
    const open = await new Promise((done) => {
      socket.on('connect', () => done(true)).on('error', () => done(false));
    });
    socket.destroy();
    if (open) return;
    await sleep(40);
  }
  throw new Error(`${nginx} does not listen`);
}

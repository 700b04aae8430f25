// Writes the declarations of the package into types/: those of the sources, by the TypeScript compiler of
// the page, and the ones that are written as declarations. `npm pack` runs it.

import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readdirSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const places = [here, join(here, '../../web')];
const compiler = createRequire(import.meta.url).resolve('typescript/bin/tsc', { paths: places });
const types = join(here, 'types');

rmSync(types, { recursive: true, force: true });
mkdirSync(types);
const options = ['--declaration', '--emitDeclarationOnly', '--allowJs', '--checkJs', '--strict'];
options.push('--outDir', types, '--target', 'es2022', '--module', 'esnext');
options.push('--moduleResolution', 'bundler', '--lib', 'es2022,dom');
execFileSync(process.execPath, [compiler, ...options, join(here, 'index.js')], { stdio: 'inherit' });
for (const name of readdirSync(here).filter((name) => name.endsWith('.d.ts')))
  copyFileSync(join(here, name), join(types, name));

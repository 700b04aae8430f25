// The package as npm makes it: what is in it, and that a strict checker finds misspelt calls.

import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { cp, mkdir, mkdtemp, readFile, readdir, rm, symlink, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import test, { after, before } from 'node:test';
import { promisify } from 'node:util';

const run = promisify(execFile);
const ROOT = new URL('../../../', import.meta.url).pathname;
const TYPES = join(ROOT, 'tests/proto/types');
const COMPILER = join(ROOT, 'web/node_modules/typescript/bin/tsc');
let folder, contents;

before(async () => {
  folder = await mkdtemp(join(tmpdir(), 'weft package '));
  // A copy beside the page's packages, because packing leaves files beside the sources.
  await cp(join(ROOT, 'proto/js'), join(folder, 'proto/js'), { recursive: true });
  await mkdir(join(folder, 'web'));
  await symlink(join(ROOT, 'web/node_modules'), join(folder, 'web/node_modules'));
  const options = { cwd: join(folder, 'proto/js'), timeout: 100_000 };
  const { stdout } = await run('npm', ['pack', '--json', '--offline', '--pack-destination', folder], options);
  const [packed] = JSON.parse(stdout.slice(stdout.indexOf('[\n')));
  contents = packed;
  await mkdir(join(folder, 'node_modules/weft-client'), { recursive: true });
  await run('tar', ['xzf', join(folder, basename(packed.filename)), '--strip-components=1'], {
    cwd: join(folder, 'node_modules/weft-client'),
  });
});

after(() => rm(folder, { recursive: true, force: true }));

test('the package has every module, its declarations, the version of the project, and nothing else', async () => {
  const [, version] = /^project\(weft VERSION ([\d.]+)/m.exec(await readFile(join(ROOT, 'CMakeLists.txt'), 'utf8'));
  assert.equal(contents.version, version);
  const sources = (await readdir(join(ROOT, 'proto/js'))).filter((name) => name.endsWith('.js'));
  const declared = (await readdir(join(ROOT, 'proto/js'))).filter((name) => name.endsWith('.d.ts'));
  const types = [...sources.map((name) => name.replace(/js$/, 'd.ts')), ...declared].map((name) => `types/${name}`);
  const expected = [...sources, ...types, 'README.md', 'package.json'].sort();
  assert.deepEqual(contents.files.map(({ path }) => path).sort(), expected);
});

test('what is packed is what a script imports by its name', async () => {
  const script = "import * as weft from 'weft-client'; console.log(Object.keys(weft).join(' '))";
  const { stdout } = await run(process.execPath, ['--input-type=module', '-e', script], { cwd: folder });
  for (const name of ['WeftClient', 'CommandError', 'FrameDecoder']) assert.ok(stdout.split(/\s/).includes(name), name);
});

test('a strict checker finds each misspelt call and nothing else', async () => {
  for (const name of ['script_good.ts', 'script_bad.ts']) await cp(join(TYPES, name), join(folder, name));
  const options = { strict: true, noEmit: true, target: 'es2022', module: 'esnext', moduleResolution: 'bundler' };
  const config = { compilerOptions: { ...options, lib: ['es2022', 'dom'], types: [] }, include: ['script_*.ts'] };
  await writeFile(join(folder, 'tsconfig.json'), JSON.stringify(config));
  const done = await run(process.execPath, [COMPILER, '-p', folder], { cwd: folder }).catch((failed) => failed);
  const found = [...done.stdout.matchAll(/^(\S+)\((\d+),\d+\): error/gm)].map(([, file, line]) => `${file}:${line}`);
  const lines = (await readFile(join(TYPES, 'script_bad.ts'), 'utf8')).split('\n');
  const wrong = lines.flatMap((line, i) => (line.endsWith('// wrong') ? [`script_bad.ts:${i + 1}`] : []));
  assert.ok(wrong.length > 15);
  assert.deepEqual([...new Set(found)], wrong, done.stdout);
});

import assert from 'node:assert/strict';
import { readdir, readFile } from 'node:fs/promises';
import test from 'node:test';
import { fileURLToPath } from 'node:url';
import { slim_three } from '../../web/slim_three.mjs';
import { require_package } from './support/packages.mjs';

// What the page's build leaves out of three.

const { build } = require_package('esbuild');
const web = fileURLToPath(new URL('../../web', import.meta.url));

async function shaders(plugins) {
  const contents = "export { ShaderChunk } from 'three';";
  const { outputFiles } = await build({
    stdin: { contents, resolveDir: web },
    bundle: true,
    format: 'esm',
    write: false,
    plugins,
  });
  const text = Buffer.from(outputFiles[0].text).toString('base64');
  return (await import(`data:text/javascript;base64,${text}`)).ShaderChunk;
}

test('shaders of the page are the renderer’s own, but for comments and white space', async () => {
  const [whole, slim] = [await shaders([]), await shaders([slim_three])];
  const bare = (text) => text.replace(/\/\*[\s\S]*?\*\/|\/\/.*$/gm, '').replace(/\s+/g, '');
  const names = Object.keys(whole);
  assert.ok(names.length > 100);
  const missing = names.filter((name) => slim[name] === '' && whole[name] !== '');
  const kept = names.filter((name) => !missing.includes(name));
  for (const name of kept) assert.equal(bare(slim[name]), bare(whole[name]), name);
  assert.ok(missing.length > 10, 'unused ones are left out');
});

test('the page uses no material whose shader is left out', async () => {
  const left_out =
    /\b(PointsMaterial|SpriteMaterial|LineDashedMaterial|Mesh(Phong|Toon|Matcap|Normal|Distance)Material|PointLight|VSMShadowMap)\b|\.background\b/;
  for (const name of await readdir(`${web}/src`, { recursive: true })) {
    if (!name.endsWith('.ts')) continue;
    const found = left_out.exec(await readFile(`${web}/src/${name}`, 'utf8'));
    assert.equal(found, null, `${name}: ${found?.[0]}`);
  }
});

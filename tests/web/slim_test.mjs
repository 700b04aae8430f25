import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readdir, readFile } from 'node:fs/promises';
import test from 'node:test';
import { fileURLToPath } from 'node:url';
import { slim_three, UNDEFINED, UNUSED_FUNCTIONS, with_one_curve, with_slim_own } from '../../web/slim_three.mjs';
import { require_package } from './support/packages.mjs';

// What the page's build leaves out of three.

const { build } = require_package('esbuild');
const web = fileURLToPath(new URL('../../web', import.meta.url));

/** All of three's shaders that a bundle has, by their names. */
async function shaders(plugins) {
  const contents = `
    import { ShaderChunk } from 'three';
    import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
    const { vertexShader, fragmentShader } = new LineMaterial();
    export const texts = { ...ShaderChunk, line_vertex: vertexShader, line_fragment: fragmentShader };`;
  const { outputFiles } = await build({
    stdin: { contents, resolveDir: web },
    bundle: true,
    format: 'esm',
    write: false,
    plugins,
  });
  const text = Buffer.from(outputFiles[0].text).toString('base64');
  return (await import(`data:text/javascript;base64,${text}`)).texts;
}

/** What the compiler's preprocessor leaves of shaders where so many macros are 1, without white space. */
function preprocessed(texts, defined) {
  const others = /^[ \t]*#[ \t]*(?!if|elif|else|endif|define|undef)(\w+)/gm; // such as #include
  const input = texts.map((text) => text.replaceAll(others, 'hash_$1')).join('\nend_of_shader\n');
  const options = ['-P', '-undef', '-nostdinc', ...defined.map((name) => `-D${name}=1`)];
  const output = execFileSync('cpp', ['-w', ...options], { input, encoding: 'utf8', maxBuffer: 1e8 });
  return output.split('end_of_shader').map((text) => text.replace(/\s+/g, ''));
}

test('whatever a material of the page defines, its shaders are the renderer’s own', async () => {
  const [whole, slim] = [await shaders([]), await shaders([slim_three])];
  const names = Object.keys(whole);
  assert.ok(names.length > 100);
  const curves = (text) => text.match(/\w+(?=ToneMapping\()/g);
  assert.ok(curves(whole.tonemapping_pars_fragment).length > 5);
  assert.deepEqual(curves(slim.tonemapping_pars_fragment), ['Neutral', 'Custom']);
  whole.tonemapping_pars_fragment = with_one_curve(whole.tonemapping_pars_fragment);
  const missing = names.filter((name) => slim[name] === '' && whole[name] !== '');
  assert.ok(missing.length > 10, 'unused ones are left out');
  const kept = names.filter((name) => !missing.includes(name));
  const conditions = Object.values(whole).flatMap((text) => text.match(/^\s*#\s*(if|elif).*/gm) ?? []);
  const macros = new Set(conditions.flatMap((line) => line.match(/\b[A-Z]\w+\b/g) ?? []));
  const possible = [...macros].filter((name) => !UNDEFINED.has(name));
  assert.ok(possible.length > 20);
  for (const defined of [[], possible, ...possible.map((name) => [name])]) {
    const [before, after] = [whole, slim].map((texts) =>
      preprocessed(kept.map((name) => texts[name]), defined),
    );
    assert.deepEqual(after, before, `with ${defined}`);
  }
  const [size, before] = [slim, whole].map((texts) => Object.values(texts).join('').length);
  assert.ok(size < before / 2, `${size} characters of ${before} are left`);
});

/** What a source may name of what is left out, apart from properties that are called as their macro. */
const LEFT_OUT =
  /\b(PointsMaterial|SpriteMaterial|LineDashedMaterial|Mesh(Lambert|Phong|Toon|Matcap|Normal|Distance)Material|VSMShadowMap|CubeTexture\w*|CubeCamera|UniformsGroup|(Instanced|Batched|Skinned)Mesh|Fog\w*|ObjectSpaceNormalMap|(Linear|Reinhard|Cineon|ACESFilmic|AgX)ToneMapping|computeTangents|vertexTangents)\b|\.(background|toJSON|xr)\b/;

/** A macro as three calls what defines it, but for capitals: USE_SHEEN_COLORMAP is of sheenColorMap. */
const property_of = (macro) => macro.replace(/^(USE|NUM)_|S$|_/g, '').toLowerCase();

test('the page uses nothing of three that is left out', async () => {
  const properties = [...UNDEFINED].map(property_of).filter((name) => name !== 'map').join('|');
  const set = new RegExp(`\\b(${properties})s?\\b`, 'i');
  for (const name of await readdir(`${web}/src`, { recursive: true })) {
    if (!name.endsWith('.ts')) continue;
    const text = (await readFile(`${web}/src/${name}`, 'utf8')).replace(/\/\*[\s\S]*?\*\/|\/\/.*$/gm, '');
    const call = new RegExp(`\\.(${UNUSED_FUNCTIONS.join('|')})\\(`);
    for (const left_out of [LEFT_OUT, set, /\bmap:|\.map = /, call]) {
      assert.equal(left_out.exec(text)?.[0] ?? null, null, name);
    }
  }
});

test('of the page’s own shaders white space and comments are left out, and nothing else', async () => {
  const view = new URL('../../web/src/view/', import.meta.url);
  const essence = (text) => text.replace(/\/\*[\s\S]*?\*\/|\/\/.*$/gm, '').replace(/\s+/g, '');
  const quoted = (text) => text.match(/'[^'\n]*'/g);
  let [before, after] = [0, 0];
  for (const name of await readdir(view)) {
    const text = await readFile(new URL(name, view), 'utf8');
    const slim = with_slim_own(text);
    assert.equal(essence(slim), essence(text), name);
    before += text.length;
    after += slim.length;
    if (slim !== text && !name.startsWith('floor')) assert.deepEqual(quoted(slim), quoted(text), name);
  }
  assert.ok(before - after > 1000, `${before - after}`);
});

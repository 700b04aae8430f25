import { fileURLToPath } from 'node:url';
import { require_package } from './packages.mjs';

const { build } = require_package('esbuild');

/** Imports a TypeScript module of the page that needs no browser. @param {string} name such as "view/ray" */
export async function import_page_module(name) {
  const { outputFiles } = await build({
    entryPoints: [fileURLToPath(new URL(`../../../web/src/${name}.ts`, import.meta.url))],
    bundle: true,
    format: 'esm',
    write: false,
  });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].text).toString('base64')}`);
}

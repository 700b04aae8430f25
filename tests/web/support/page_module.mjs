import { fileURLToPath } from 'node:url';
import { slim_three } from '../../../web/slim_three.mjs';
import { require_package } from './packages.mjs';

const { build } = require_package('esbuild');

/**
 * Imports TypeScript modules of the page that need no browser, as one, with three as the page has it.
 * @param {string[]} names such as "view/ray"
 */
export async function import_page_module(...names) {
  const { outputFiles } = await build({
    stdin: {
      contents: names.map((name) => `export * from './${name}.ts';`).join('\n'),
      resolveDir: fileURLToPath(new URL('../../../web/src', import.meta.url)),
    },
    bundle: true,
    format: 'esm',
    write: false,
    plugins: [slim_three],
  });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].text).toString('base64')}`);
}

// A plugin of esbuild that makes three.js smaller: it bundles three's own sources, and from them the
// shaders without their comments and indents, and none of those that the page does not use.
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";

const sources = join(dirname(createRequire(import.meta.url).resolve("three")), "..", "src");
const UNUSED =
  /ShaderLib[/\\](background|backgroundCube|cube|distanceRGBA|equirect|linedashed|meshmatcap|meshnormal|meshphong|meshtoon|points|sprite|vsm)\.glsl\.js$/;

export const slim_three = {
  name: "slim three",
  setup(build) {
    build.onResolve({ filter: /^three$/ }, () => ({ path: join(sources, "Three.js") }));
    build.onLoad({ filter: /[/\\]shaders[/\\].*\.glsl\.js$/ }, async ({ path }) => {
      if (UNUSED.test(path)) return { contents: "export const vertex = '', fragment = '';" };
      const text = await readFile(path, "utf8");
      return { contents: text.replace(/`([^`]*)`/g, (_, shader) => `\`${without_comments(shader)}\``) };
    });
  },
};

/** Line breaks stay, because they end directives. */
function without_comments(shader) {
  return shader
    .replace(/\/\*[\s\S]*?\*\//g, "")
    .replace(/\/\/.*$/gm, "")
    .replace(/[ \t]+/g, " ")
    .replace(/\s*\n\s*/g, "\n");
}

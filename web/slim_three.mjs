// A plugin of esbuild that makes three.js smaller: it bundles three's own sources without what the
// page never uses, and shaders, the page's own too, without comments and indents.
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";

const sources = join(dirname(createRequire(import.meta.url).resolve("three")), "..", "src");

const UNUSED_SHADERS =
  /ShaderLib[/\\](background|backgroundCube|cube|distanceRGBA|equirect|linedashed|meshlambert|meshmatcap|meshnormal|meshphong|meshtoon|points|sprite|vsm)\.glsl\.js$/;

/** Macros that are defined, or counts above 0, only for what no material, light or mesh here has. */
export const UNDEFINED = new Set([
  ...["ALPHAHASH", "ALPHAMAP", "ALPHATEST", "ANISOTROPYMAP", "AOMAP", "BATCHING", "BATCHING_COLOR"],
  ...["BUMPMAP", "CLEARCOAT", "CLEARCOATMAP", "CLEARCOAT_NORMALMAP", "CLEARCOAT_ROUGHNESSMAP"],
  ...["DISPERSION", "DISPLACEMENTMAP", "EMISSIVEMAP", "FOG", "GRADIENTMAP", "INSTANCING"],
  ...["INSTANCING_COLOR", "INSTANCING_MORPH", "IRIDESCENCE", "IRIDESCENCEMAP"],
  ...["IRIDESCENCE_THICKNESSMAP", "LIGHTMAP", "LIGHT_PROBES", "LOGARITHMIC_DEPTH_BUFFER", "MAP"],
  ...["MATCAP", "METALNESSMAP", "MORPHCOLORS", "MORPHNORMALS", "MORPHTARGETS"],
  ...["NORMALMAP_OBJECTSPACE", "POINTS_UV", "REVERSED_DEPTH_BUFFER", "ROUGHNESSMAP"],
  ...["SHEEN_COLORMAP", "SHEEN_ROUGHNESSMAP", "SKINNING", "SPECULARMAP", "SPECULAR_COLORMAP"],
  ...["SPECULAR_INTENSITYMAP", "TANGENT", "THICKNESSMAP", "TRANSMISSION", "TRANSMISSIONMAP"],
].map((feature) => `USE_${feature}`));
for (const kind of ["POINT_LIGHTS", "POINT_LIGHT_SHADOWS", "RECT_AREA_LIGHTS", "SPOT_LIGHTS",
  "SPOT_LIGHT_COORDS", "SPOT_LIGHT_MAPS", "SPOT_LIGHT_SHADOWS", "CLIPPING_PLANES"]) {
  UNDEFINED.add(`NUM_${kind}`);
}

/** Functions of the renderer that nothing here calls. */
export const UNUSED_FUNCTIONS = ["compileAsync", "copyTextureToTexture", "forceContextLoss", "forceContextRestore",
  "initRenderTarget", "initTexture", "readRenderTargetPixelsAsync", "resetState"];

/** Parts of the renderer that have nothing to do here: headsets, blocks of uniforms, cube maps. */
const STAND_INS = new Map([
  [
    join("renderers", "webxr", "WebXRManager.js"),
    `import { EventDispatcher } from "../../core/EventDispatcher.js";
     export class WebXRManager extends EventDispatcher {
       enabled = false;
       isPresenting = false;
       cameraAutoUpdate = true;
       getEnvironmentBlendMode() {}
       setAnimationLoop() {}
       dispose() {}
     }`,
  ],
  [
    join("renderers", "webgl", "WebGLUniformsGroups.js"),
    "export class WebGLUniformsGroups { bind() {} update() {} dispose() {} }",
  ],
  [
    join("renderers", "webgl", "WebGLCubeMaps.js"),
    "export class WebGLCubeMaps { get(texture) { return texture; } dispose() {} }",
  ],
]);

export const slim_three = {
  name: "slim three",
  setup(build) {
    build.onResolve({ filter: /^three$/ }, () => ({ path: join(sources, "Three.js") }));
    build.onLoad({ filter: /[/\\]node_modules[/\\]three[/\\].*\.js$/ }, async ({ path }) => {
      if (UNUSED_SHADERS.test(path)) return { contents: "export const vertex = '', fragment = '';" };
      const stand_in = path.startsWith(sources) && STAND_INS.get(path.slice(sources.length + 1));
      if (stand_in) return { contents: stand_in };
      const text = await readFile(path, "utf8");
      const has_shader = /\.glsl\.js$|[/\\](lines[/\\]LineMaterial|extras[/\\]PMREMGenerator)\.js$/.test(path);
      return { contents: has_shader ? with_slim_shaders(text) : without_unused(without_saving(text)) };
    });
    build.onLoad({ filter: /[/\\]src[/\\]view[/\\].*\.ts$/ }, async ({ path }) => {
      const text = await readFile(path, "utf8");
      return { contents: with_slim_own(text), loader: "ts" };
    });
  },
};

/** Shaders of the page's own are its templates with statements on several lines. */
export function with_slim_own(text) {
  return text.replace(/`[^`]*`/g, (part) => (part.includes(";\n") ? without_comments(part) : part));
}

/** No scene is written to a file. */
function without_saving(text) {
  return text.replace(/\n\ttoJSON\([^)]*\) \{\n[\s\S]*?\n\t\}\n/g, "\n");
}

/** The renderer's functions stand two tabs deep, and end where a line closes at that depth. */
function without_unused(text) {
  const unused = new RegExp(`\\n\\t\\tthis\\.(${UNUSED_FUNCTIONS.join("|")}) = [\\s\\S]*?\\n\\t\\t\\};\\n`, "g");
  return text.replace(unused, "");
}

function with_slim_shaders(text) {
  return text.replace(/`([^`]*)`/g, (_, shader) => `\`${without_branches(without_comments(with_one_curve(shader)))}\``);
}

/** Of three's curves of tone the page has the neutral one; the others stand before it. */
export function with_one_curve(shader) {
  return shader.replace(/vec3 LinearToneMapping\([\s\S]*(?=vec3 NeutralToneMapping\()/, "");
}

/** Line breaks stay, because they end directives, and so do spaces within these. */
function without_comments(shader) {
  return shader
    .replace(/\/\*[\s\S]*?\*\//g, "")
    .replace(/\/\/.*$/gm, "")
    .replace(/[ \t]+/g, " ")
    .replace(/\s*\n\s*/g, "\n")
    .replace(/^[^#].*$/gm, without_spaces);
}

/** Two signs in a row keep their spaces. */
function without_spaces(line) {
  return line.replace(/ ?([=*/,;?:]) ?/g, "$1").replace(/\( | \)/g, (two) => two.trim())
    .replace(/(?<=[\w).\]]) ([+-]) (?=[\w(.])/g, "$1");
}

/** Leaves out what the preprocessor would, as nothing in `UNDEFINED` is defined or above 0. */
function without_branches(shader) {
  const lines = [];
  const chains = []; // conditions around a line; of each: whether it is decided, met, and kept now
  const keep = (line) => chains.every(({ kept }) => kept) && lines.push(line);
  for (const line of shader.split("\n")) {
    const [, directive] = /^\s*#\s*(ifdef|ifndef|if|elif|else|endif)\b/.exec(line) ?? [];
    const chain = chains.at(-1);
    if (directive?.startsWith("if")) {
      const met = value_of(line);
      if (met === null) keep(line);
      chains.push({ decided: met !== null, met, kept: met !== false });
    } else if (directive === "endif") {
      chains.pop();
      if (!chain.decided) keep(line);
    } else if (!directive || !chain.decided) {
      keep(line);
    } else if (directive === "else" || chain.met) {
      chain.kept = !chain.met;
    } else {
      Object.assign(chain, { decided: false, kept: true });
      keep(line.replace("elif", "if"));
    }
  }
  return lines.join("\n");
}

/** Whether a condition is true; null where that depends on the material. */
function value_of(line) {
  const [, negated, name] = /^\s*#\s*if(n?)def\s+(\w+)\s*$/.exec(line) ?? [];
  if (name) return UNDEFINED.has(name) ? negated === "n" : null;
  const defined = /^\s*#\s*if\s+defined\s*\(\s*(\w+)\s*\)(?:\s*&&.*)?\s*$/.exec(line);
  if (defined && !line.includes("||")) return UNDEFINED.has(defined[1]) ? false : null;
  const count = /^\s*#\s*if\s+\(?\s*(NUM_\w+) > 0\s*\)?(?:\s*&&.*)?\s*$/.exec(line);
  return count && !line.includes("||") && UNDEFINED.has(count[1]) ? false : null;
}

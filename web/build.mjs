// Bundles src/main.ts and the styles with all they import, and copies the files of static/ and the pictures of scenes
// beside them.
// usage: node build.mjs OUTPUT_DIRECTORY DEPENDENCY_FILE
import { build } from "esbuild";
import { cp, mkdir, readdir, readFile, rm, writeFile } from "node:fs/promises";
import { dirname, join, parse, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";
import { brotliCompress, gzip } from "node:zlib";
import { slim_three } from "./slim_three.mjs";

const [output, dependency_file] = process.argv.slice(2).map((path) => resolve(path));
const here = dirname(fileURLToPath(import.meta.url));
const static_files = join(here, "static");
const scene_pictures = join(here, "picture", "scenes");

// A file that is gone from the sources must be gone from the page.
await rm(output, { recursive: true, force: true });
await mkdir(output, { recursive: true });
await cp(static_files, output, { recursive: true });

// Indentation is for those who read the source.
const document = join(output, "index.html");
await writeFile(document, (await readFile(document, "utf8")).replace(/\n\s+/g, "\n"));

// The page asks for a picture only if there is one.
const pictures = (await readdir(scene_pictures)).filter((name) => name.endsWith(".jpg"));
await cp(scene_pictures, join(output, "scenes"), { recursive: true });
await writeFile(
  join(output, "scenes", "pictures.json"),
  JSON.stringify(pictures.map((name) => parse(name).name)),
);

// The first is part of the first load; each other one comes with what it is for.
const sheets = ["styles", "people", "rooms", "scenes"];

const { metafile } = await build({
  absWorkingDir: here,
  entryPoints: ["src/main.ts", "src/wire/frame_worker.ts", ...sheets.map((name) => `styles/${name}.css`)],
  entryNames: "[name]",
  outdir: output,
  bundle: true,
  splitting: true, // what is imported when it is needed is no part of the first load
  minify: true,
  pure: ["console.warn"], // hints of three for its programmers are left out
  sourcemap: true,
  format: "esm",
  target: "es2022",
  plugins: [slim_three],
  metafile: true,
  logLevel: "warning",
});

// The server sends these forms to browsers that take them; beside each text its .gz and .br.
for (const name of await readdir(output, { recursive: true })) {
  if (!/\.(html|js|css|svg)$/.test(name)) continue;
  const bytes = await readFile(join(output, name));
  await writeFile(join(output, `${name}.gz`), await promisify(gzip)(bytes, { level: 9 }));
  await writeFile(join(output, `${name}.br`), await promisify(brotliCompress)(bytes));
}

// Make's form, in which a space of a path is escaped. The folder of the static files stands for a
// file that comes or goes.
const copied = await readdir(static_files, { recursive: true });
const inputs = [
  ...Object.keys(metafile.inputs),
  static_files,
  ...copied.map((name) => join(static_files, name)),
  scene_pictures,
  ...pictures.map((name) => join(scene_pictures, name)),
].map((path) => resolve(here, path));
const escape = (path) => path.replaceAll(" ", "\\ ");
await mkdir(dirname(dependency_file), { recursive: true });
await writeFile(
  dependency_file,
  `${escape(join(output, "main.js"))}: ${inputs.map(escape).join(" \\\n  ")}\n`,
);

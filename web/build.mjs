// Bundles the page into the folder given: node build.mjs FOLDER. Type errors end the build.
import { spawnSync } from "node:child_process";
import { cpSync, mkdirSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = fileURLToPath(new URL(".", import.meta.url));
const folder = process.argv[2];
if (!folder) {
  console.error("usage: node build.mjs FOLDER");
  process.exit(2);
}

const tsc = createRequire(import.meta.url).resolve("typescript/bin/tsc");
const types = spawnSync(process.execPath, [tsc, "--noEmit", "-p", here], { stdio: "inherit" });
if (types.status !== 0) process.exit(1);

mkdirSync(folder, { recursive: true });
cpSync(join(here, "static"), folder, { recursive: true });
await build({
  entryPoints: [join(here, "src", "main.ts")],
  outfile: join(folder, "main.js"),
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  sourcemap: true,
  logLevel: "warning",
});

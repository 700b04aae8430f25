// Converts the meshes of installed packages to files that the server reads.
// usage: node meshes.mjs OUTPUT_DIRECTORY
import { mkdir, writeFile } from "node:fs/promises";
import { join } from "node:path";
import bunny from "bunny";

function as_ply({ positions, cells }) {
  const head = [
    "ply",
    "format ascii 1.0",
    `element vertex ${positions.length}`,
    ...["x", "y", "z"].map((axis) => `property float ${axis}`),
    `element face ${cells.length}`,
    "property list uchar int vertex_indices",
    "end_header",
  ];
  const vertices = positions.map((position) => position.join(" "));
  const faces = cells.map((cell) => `${cell.length} ${cell.join(" ")}`);
  return `${[...head, ...vertices, ...faces].join("\n")}\n`;
}

const output = process.argv[2];
await mkdir(output, { recursive: true });
await writeFile(join(output, "bunny.ply"), as_ply(bunny));

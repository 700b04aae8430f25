import {
  Color,
  DataTexture,
  DoubleSide,
  LinearFilter,
  LinearMipmapLinearFilter,
  MeshPhysicalMaterial,
  RepeatWrapping,
  Vector2,
} from 'three';

const TWILL_SIZE = 128; // pixels of a tile
const THREADS = 8; // of a tile, in both directions
const THREADS_PER_METRE = 900;
const HEM = 0.014; // [m]

/** A woven cloth with the sheen of fine wool. @param width, height of the cloth in its plane [m] */
export function fabric_material(width: number, height: number): MeshPhysicalMaterial {
  const relief = twill_normals();
  relief.repeat.set(
    (width * THREADS_PER_METRE) / THREADS,
    (height * THREADS_PER_METRE) / THREADS,
  );
  const material = new MeshPhysicalMaterial({
    color: new Color('#cb5238'),
    roughness: 0.82,
    sheen: 0.6,
    sheenRoughness: 0.45,
    sheenColor: new Color('#ffab92'),
    normalMap: relief,
    normalScale: new Vector2(0.55, 0.55),
    side: DoubleSide,
    shadowSide: DoubleSide,
    dithering: true,
  });
  material.onBeforeCompile = (shader) => {
    shader.uniforms.hem = { value: new Vector2(HEM / width, HEM / height) };
    shader.vertexShader = shader.vertexShader
      .replace('void main() {', 'varying vec2 fabric_place;\nvoid main() {\nfabric_place = uv;')
      .replace('#include <shadowmap_vertex>', SHADOW_OF_BOTH_SIDES);
    shader.fragmentShader = shader.fragmentShader
      .replace('void main() {', 'uniform vec2 hem;\nvarying vec2 fabric_place;\nvoid main() {')
      .replace('#include <color_fragment>', HEM_SHADE);
  };
  return material;
}

/**
 * The shadow is looked up slightly in front of the surface, on the visible side, which may be the
 * left side of the cloth; behind it, the cloth would lie in its own shadow.
 */
const SHADOW_OF_BOTH_SIDES = `
  transformedNormal = faceforward(transformedNormal, mvPosition.xyz, transformedNormal);
  #include <shadowmap_vertex>
`;

/** A hem slightly darker than the cloth, with the line of its seam; the left side is paler. */
const HEM_SHADE = `
  #include <color_fragment>
  vec2 from_edge = min(fabric_place, 1.0 - fabric_place) / hem;
  float edge = min(from_edge.x, from_edge.y);
  float blur = max(fwidth(edge), 0.02);
  diffuseColor.rgb *= 1.0 - 0.07 * (1.0 - smoothstep(1.0 - blur, 1.0 + blur, edge));
  diffuseColor.rgb *= 1.0 - 0.16 * (1.0 - smoothstep(0.0, 0.10 + blur, abs(edge - 1.0)));
  if (!gl_FrontFacing) diffuseColor.rgb *= vec3(0.86, 0.82, 0.84);
`;

/**
 * Normals of a 2/2 twill: each thread passes over two and under two, shifted by one in each row.
 */
function twill_normals(): DataTexture {
  const size = TWILL_SIZE;
  const height = new Float32Array(size * size);
  for (let y = 0; y < size; y++) {
    for (let x = 0; x < size; x++) height[y * size + x] = twill_height(x / size, y / size);
  }
  const pixels = new Uint8Array(size * size * 4);
  const at = (x: number, y: number) => height[((y + size) % size) * size + ((x + size) % size)];
  for (let y = 0; y < size; y++) {
    for (let x = 0; x < size; x++) {
      const slope_x = (at(x + 1, y) - at(x - 1, y)) * 3;
      const slope_y = (at(x, y + 1) - at(x, y - 1)) * 3;
      const length = Math.hypot(slope_x, slope_y, 1);
      const normal = [-slope_x / length, -slope_y / length, 1 / length];
      const offset = (y * size + x) * 4;
      for (let i = 0; i < 3; i++) pixels[offset + i] = Math.round((normal[i] * 0.5 + 0.5) * 255);
      pixels[offset + 3] = 255;
    }
  }
  const texture = new DataTexture(pixels, size, size);
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.magFilter = LinearFilter;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  texture.anisotropy = 8;
  texture.needsUpdate = true;
  return texture;
}

function twill_height(u: number, v: number): number {
  const warp = u * THREADS;
  const weft = v * THREADS;
  const phase = (((Math.floor(warp) - Math.floor(weft)) % 4) + 4) % 4;
  const across = phase < 2 ? warp % 1 : weft % 1;
  const along = phase < 2 ? weft % 1 : warp % 1;
  return Math.sin(Math.PI * across) * (0.75 + 0.25 * Math.sin(Math.PI * along));
}

import { Color, DoubleSide, MeshPhysicalMaterial, SRGBColorSpace, Vector2, Vector3, Vector4 } from 'three';
import type { Look } from '../../../proto/js/messages.js';
import { back_of, finish_of } from './looks.js';
import type { Finish } from './looks.js';
import type { Round } from './round.js';
import type { Weave } from './weave.js';

const HEM = 0.014; // [m]
const LARGEST_HEM = 0.06; // of the cloth's shorter side
const STITCH = 0.005; // [m]
const STRIPES = 0.07; // from one to the next [m]

/** Whether weaves and hems are drawn; tests switch them off to measure the shading alone. */
export const pattern = { value: 1 };

/** What a cloth is in its plane [m]. */
export interface Cut {
  /** Null if it is neither a rectangle nor round. */
  size: [number, number] | null;
  round: Round | null;
}

/**
 * A cloth seen from both sides.
 * @param color of the front
 */
export function fabric_material(
  look: Look | undefined,
  color: Color,
  weave: Weave,
  cut: Cut,
): MeshPhysicalMaterial {
  const finish = finish_of(look);
  const tile = finish.period * weave.periods;
  weave.texture.repeat.set(1 / tile, 1 / tile);
  const material = new MeshPhysicalMaterial({
    color,
    roughness: finish.roughness,
    specularIntensity: finish.specular,
    anisotropy: finish.anisotropy,
    anisotropyRotation: Math.PI / 2, // highlights spread across the threads that float, the warp
    sheen: finish.sheen,
    sheenRoughness: finish.sheen_roughness,
    sheenColor: sheen_of(color),
    normalMap: weave.texture,
    normalScale: new Vector2(finish.relief, finish.relief),
    transparent: finish.clear > 0,
    forceSinglePass: true, // its triangles are sorted
    side: DoubleSide,
    shadowSide: DoubleSide,
    dithering: true,
  });
  const uniforms = uniforms_of(finish, back_of(look, color), color, weave, cut);
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = shader.vertexShader
      .replace('void main() {', PLACE_IN_CLOTH)
      .replace('#include <shadowmap_vertex>', SHADOW_TOWARDS_LIGHT);
    shader.fragmentShader = [...FRAGMENT].reduce(
      (text, [chunk, code]) => text.replace(chunk, code),
      shader.fragmentShader,
    );
  };
  return material;
}

/** A pale tint of the cloth itself; any other colour looks like dust at grazing angles. */
function sheen_of(color: Color): Color {
  const { h, s, l } = color.getHSL({ h: 0, s: 0, l: 0 }, SRGBColorSpace);
  return new Color().setHSL(h, s, Math.min(0.9, l * 0.75 + 0.25), SRGBColorSpace);
}

/** The fabric's stripes, or another shade of a cloth that is not of the fabric's colour. */
function stripe_of({ color, stripe }: Finish, front: Color): Color {
  return front.equals(new Color(color)) ? new Color(stripe) : front.clone().multiplyScalar(0.4);
}

function uniforms_of(
  finish: Finish,
  back: Color,
  color: Color,
  weave: Weave,
  { size, round }: Cut,
) {
  const [width, height] = size ?? [1, 1];
  const hem = size ? Math.min(HEM, LARGEST_HEM * Math.min(width, height)) : 0;
  const seam = finish.seam ? new Color(finish.seam) : color.clone().multiplyScalar(0.45);
  return {
    pattern_shown: pattern,
    back_color: { value: back },
    back_roughness: { value: finish.back_roughness },
    weave_periods: { value: weave.periods },
    weave_weft: { value: weave.weft },
    grooves: { value: finish.grooves },
    white_weft: { value: finish.white_weft },
    clear: { value: finish.clear },
    translucency: { value: finish.translucency },
    cloth_size: { value: new Vector3(width, height, hem) },
    disc: { value: round ? new Vector4(...round.center, ...round.radii) : new Vector4() },
    seam_color: { value: seam },
    stripe_color: { value: finish.stripe ? stripe_of(finish, color) : color },
    striped: { value: finish.stripe ? 1 : 0 },
    stitched: { value: finish.seam ? 1 : 0 },
  };
}

const PLACE_IN_CLOTH = `
  varying vec2 fabric_place;
  #ifdef USE_ANISOTROPY
    attribute vec3 weft;
    varying vec3 weft_way;
  #endif
  void main() {
    fabric_place = uv;
    #ifdef USE_ANISOTROPY
      weft_way = normalMatrix * weft;
    #endif
`;

/**
 * Shadows are looked up slightly on the side of the cloth that their light falls on. On the other
 * side the cloth would lie in its own shadow, and no light would pass through it. A light's way is
 * the direction in which the depth of its shadow grows; all shadows are of directional lights.
 */
const SHADOW_TOWARDS_LIGHT = `
  #if defined(USE_SHADOWMAP) && NUM_DIR_LIGHT_SHADOWS > 0
    vec3 world_normal = inverseTransformDirection(transformedNormal, viewMatrix);
    mat4 to_shadow;
    vec3 light_way, offset;
    #pragma unroll_loop_start
    for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
      to_shadow = directionalShadowMatrix[ i ];
      light_way = vec3(to_shadow[0].z, to_shadow[1].z, to_shadow[2].z);
      offset = faceforward(world_normal, light_way, world_normal);
      offset *= directionalLightShadows[ i ].shadowNormalBias;
      vDirectionalShadowCoord[ i ] = to_shadow * (worldPosition + vec4(offset, 0.0));
    }
    #pragma unroll_loop_end
  #endif
`;

const DECLARATIONS = `
  uniform float pattern_shown, back_roughness, weave_periods, weave_weft, grooves, white_weft;
  uniform float clear, stitched, striped;
  uniform vec3 back_color, cloth_size, seam_color, stripe_color;
  uniform vec4 disc;
  varying vec2 fabric_place;
  #ifdef USE_ANISOTROPY
    varying vec3 weft_way;
  #endif
  /** How much of a pixel a stripe covers, from distances in its period. */
  float stripe(float from_middle, float half_width, float pixel) {
    float reach = max(pixel, 1e-4);
    float inside = clamp((half_width - abs(from_middle)) / reach + 0.5, 0.0, 1.0);
    return inside * min(1.0, 2.0 * half_width / reach);
  }
  void main() {
    vec2 disc_place = (fabric_place - disc.xy) / max(disc.zw, vec2(1e-6));
    bool is_round = disc.z > 0.0;
    if (is_round && dot(disc_place, disc_place) > 1.0) discard;
`;

/**
 * Colour of the threads. A weave too fine for the picture is faded out, because what would be left
 * of it are stripes that the cloth does not have.
 */
const DYE = `
  #include <color_fragment>
  vec4 weave = texture2D(normalMap, vNormalMapUv);
  vec2 periods_per_pixel = fwidth(vNormalMapUv) * weave_periods;
  float weave_seen = pattern_shown *
    (1.0 - smoothstep(0.12, 0.3, max(periods_per_pixel.x, periods_per_pixel.y)));
  float weft = mix(weave_weft, weave.b, weave_seen);
  float across = fabric_place.y / ${STRIPES};
  float pixel = fwidth(across);
  float from_middle = abs(fract(across) - 0.5);
  float stripes = stripe(from_middle, 0.05, pixel) + stripe(from_middle - 0.11, 0.013, pixel);
  diffuseColor.rgb = mix(diffuseColor.rgb, stripe_color, 0.8 * striped * pattern_shown * min(1.0, stripes));
  vec3 front = mix(diffuseColor.rgb, vec3(0.8), white_weft * weft);
  vec3 behind = mix(back_color, stripe_color, 0.6 * striped * pattern_shown * min(1.0, stripes));
  vec3 back = mix(behind, diffuseColor.rgb, white_weft * weft);
  diffuseColor.rgb = gl_FrontFacing ? back : front;
  diffuseColor.rgb *= 1.0 + grooves * weave_seen * (2.0 * weave.a - 1.0);

  vec2 from_edge = min(fabric_place, cloth_size.xy - fabric_place);
  if (is_round) from_edge = vec2((1.0 - length(disc_place)) * min(disc.z, disc.w));
  float edge = min(from_edge.x, from_edge.y) / max(cloth_size.z, 1e-6);
  float blur = max(fwidth(edge), 0.02);
  float along = (from_edge.x < from_edge.y ? fabric_place.y : fabric_place.x) / ${STITCH};
  if (is_round) along = atan(disc_place.y, disc_place.x) * disc.z / ${STITCH};
  float dash = abs(fract(along) - 0.5) * 2.0;
  float gap = mix(0.35, smoothstep(0.62, 0.8, dash), 1.0 - smoothstep(0.1, 0.4, fwidth(along)));
  float seam = 1.0 - smoothstep(0.05, 0.09 + blur, abs(edge - 1.0));
  seam *= mix(0.3, 0.9 * (1.0 - gap), stitched) / (1.0 + 4.0 * blur);
  seam *= step(1e-5, cloth_size.z) * pattern_shown;
  diffuseColor.rgb = mix(diffuseColor.rgb, seam_color, seam);
`;

/**
 * Near an outline, the mean of neighbours' normals may look away from the eye where the surface does not.
 * Bent to the horizon, it shades the outline as what is beside it, and not as if lit from behind.
 */
const SMOOTH_FRAME = `
  #include <normal_fragment_begin>
  vec3 to_eye = normalize(vViewPosition);
  normal = normalize(normal - min(dot(normal, to_eye), 0.0) * to_eye);
  #ifdef USE_ANISOTROPY
    tbn[0] = normalize(weft_way - dot(weft_way, normal) * normal);
    vec3 warp_way = cross(normal, tbn[0]);
    tbn[1] = dot(warp_way, tbn[1]) < 0.0 ? -warp_way : warp_way;
  #endif
  tbn[2] = nonPerturbedNormal = normal;
`;

const RELIEF = `
  vec2 slope = (weave.rg * 2.0 - 1.0) * normalScale * weave_seen;
  normal = normalize(tbn * vec3(slope, sqrt(max(0.1, 1.0 - dot(slope, slope)))));
`;

/** Light that falls on the far side and leaves, scattered, on the visible one. */
const LIGHT_THROUGH = `
  #include <lights_physical_pars_fragment>
  uniform float translucency;
  void RE_Direct_Fabric(const in IncidentLight light, const in vec3 position, const in vec3 normal,
      const in vec3 view, const in vec3 coat, const in PhysicalMaterial material,
      inout ReflectedLight reflected) {
    RE_Direct_Physical(light, position, normal, view, coat, material, reflected);
    float behind = saturate(-dot(normal, light.direction));
    reflected.directDiffuse += translucency * behind * light.color * BRDF_Lambert(material.diffuseColor);
  }
  #undef RE_Direct
  #define RE_Direct RE_Direct_Fabric
`;

const SURROUNDINGS_THROUGH = `
  #include <lights_fragment_maps>
  #if defined(USE_ENVMAP) && defined(ENVMAP_TYPE_CUBE_UV)
    if (translucency > 0.0) iblIrradiance += translucency * getIBLIrradiance(-geometryNormal);
  #endif
`;

const OPACITY = `
  // Seen at a slant, a ray meets more of the threads.
  float facing = abs(dot(nonPerturbedNormal, normalize(vViewPosition)));
  diffuseColor.a = 1.0 - pow(clear, 1.0 / max(facing, 0.2));
  #include <opaque_fragment>
`;

const FRAGMENT = new Map([
  ['void main() {', DECLARATIONS],
  ['#include <color_fragment>', DYE],
  ['#include <roughnessmap_fragment>',
    'float roughnessFactor = gl_FrontFacing ? back_roughness : roughness;'],
  ['#include <normal_fragment_begin>', SMOOTH_FRAME],
  ['#include <normal_fragment_maps>', RELIEF],
  ['#include <lights_physical_pars_fragment>', LIGHT_THROUGH],
  ['#include <lights_fragment_maps>', SURROUNDINGS_THROUGH],
  ['#include <opaque_fragment>', OPACITY],
]);

import { ShaderChunk } from 'three';

const BEGIN = '#if defined( SHADOWMAP_TYPE_PCF )';
const END = '#elif defined( SHADOWMAP_TYPE_PCF_SOFT )';
const TAPS = 8;

/**
 * Replaces the renderer's even grid of shadow taps, which leaves bands in a soft edge, by a spiral
 * that is turned differently in each pixel; a shadow of radius 1 or less gets a single tap. Call it before anything is drawn.
 */
export function soften_shadows(): void {
  const chunk = ShaderChunk.shadowmap_pars_fragment;
  const [begin, end] = [chunk.indexOf(BEGIN), chunk.indexOf(END)];
  if (begin < 0 || end < begin) throw new Error('the shader of shadows has another form');
  const softened = `${chunk.slice(0, begin + BEGIN.length)}${SPIRAL}${chunk.slice(end)}`;
  ShaderChunk.shadowmap_pars_fragment = softened;
}

// Equal areas for equal steps: radii grow with the root, angles by the golden one.
const SPIRAL_POINTS = Array.from({ length: TAPS }, (_, k) => {
  const [radius, angle] = [Math.sqrt((k + 0.5) / TAPS), 2.39996 * k];
  return `vec2(${(radius * Math.cos(angle)).toFixed(5)}, ${(radius * Math.sin(angle)).toFixed(5)})`;
});

// The turn of a pixel is an even dither of both coordinates, and another one for another radius, so that
// the mean of pictures whose radii differ is smooth.
const SPIRAL = `
  if (shadowRadius <= 1.0) {
    shadow = texture2DCompare(shadowMap, shadowCoord.xy, shadowCoord.z);
  } else if (shadowIntensity > 0.0) {
  float dither = 52.9829 * fract(dot(gl_FragCoord.xy, vec2(0.06711, 0.00584)));
  float turn = 6.2832 * fract(dither + 1.618 * shadowRadius);
  vec2 reach = shadowRadius / shadowMapSize;
  mat2 turned = mat2(cos(turn), sin(turn), -sin(turn), cos(turn));
  shadow = 0.0;
  ${SPIRAL_POINTS.map(
    (point) =>
      `shadow += texture2DCompare(shadowMap, shadowCoord.xy + turned * ${point} * reach, shadowCoord.z);`,
  ).join('\n')}
  shadow /= ${TAPS}.0;
  }
`;

// WebGL 2 without graphics: it takes every call, draws nothing, and counts what is alive.

const NUMBERS = {
  RENDERER: 0x1f01,
  VERSION: 0x1f02,
  SHADING_LANGUAGE_VERSION: 0x8b8c,
  SCISSOR_BOX: 0x0c10,
  VIEWPORT: 0x0ba2,
  ACTIVE_UNIFORMS: 0x8b86,
  ACTIVE_ATTRIBUTES: 0x8b89,
  FRAMEBUFFER_COMPLETE: 0x8cd5,
};
const LARGE = 1024; // every limit that is asked for

/** What all canvases say they are drawn by. */
const renderer = { name: '' };

/**
 * @param {object} canvas
 * @param {Record<string, number>} alive is filled with counts by kind
 * @param {Record<string, number>} made  the same of all that ever were
 */
function made_up_context(canvas, alive, made) {
  const { RENDERER, VERSION, SHADING_LANGUAGE_VERSION, SCISSOR_BOX, VIEWPORT, ...rest } = NUMBERS;
  const answers = new Map([
    [RENDERER, renderer.name],
    [VERSION, 'WebGL 2.0'],
    [SHADING_LANGUAGE_VERSION, 'WebGL GLSL ES 3.00'],
    [SCISSOR_BOX, [0, 0, canvas.width, canvas.height]],
    [VIEWPORT, [0, 0, canvas.width, canvas.height]],
  ]);
  const counted = (kind, step) => {
    alive[kind] = (alive[kind] ?? 0) + step;
    if (step > 0) made[kind] = (made[kind] ?? 0) + step;
  };
  const context = {
    ...NUMBERS,
    canvas,
    getParameter: (what) => answers.get(what) ?? LARGE,
    getExtension: (name) => (name === 'EXT_color_buffer_float' ? {} : null),
    getContextAttributes: () => ({ antialias: false }),
    getShaderPrecisionFormat: () => ({ precision: 23, rangeMin: 127, rangeMax: 127 }),
    isContextLost: () => false,
    getProgramInfoLog: () => '',
    getShaderInfoLog: () => '',
    getProgramParameter: (_, what) =>
      what === rest.ACTIVE_UNIFORMS || what === rest.ACTIVE_ATTRIBUTES ? 0 : true,
    checkFramebufferStatus: () => rest.FRAMEBUFFER_COMPLETE,
    getAttribLocation: () => 0,
    getUniformLocation: () => ({}),
  };
  let next = 100_000;
  return new Proxy(context, {
    get(known, name) {
      if (name in known || typeof name !== 'string') return known[name];
      if (/^[A-Z0-9_]+$/.test(name)) return (known[name] = next++);
      const [, act, kind] = /^(create|delete)(\w+)$/.exec(name) ?? [];
      if (act === 'create') return () => (counted(kind, 1), {});
      if (act === 'delete') return (thing) => void (thing && counted(kind, -1));
      return () => undefined;
    },
  });
}

/** A canvas whose context is made up, and counts what is alive and what was ever made there. */
export function made_up_canvas(alive, made = {}) {
  const canvas = { width: 64, height: 48, style: {}, addEventListener() {}, removeEventListener() {} };
  let context;
  canvas.getContext = () => (context ??= made_up_context(canvas, alive, made));
  return canvas;
}

const made_up_label = () =>
  ({ style: { setProperty() {} }, toggleAttribute() {}, remove() {}, replaceChildren() {}, offsetWidth: 20 });

/**
 * Stands in for what the renderer and labels ask of a browser.
 * @param {string} drawn_by what all canvases say they are drawn by
 */
export function make_up_browser(drawn_by = 'a graphics card') {
  renderer.name = drawn_by;
  globalThis.self ??= globalThis;
  globalThis.window ??= { devicePixelRatio: 1 };
  globalThis.document ??= {
    createElement: (kind) => (['span', 'bdi'].includes(kind) ? made_up_label() : made_up_canvas({})),
    createElementNS: () => made_up_canvas({}),
  };
}

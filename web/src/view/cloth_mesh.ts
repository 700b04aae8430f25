import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Group, Mesh } from 'three';
import type { Camera, MeshPhysicalMaterial } from 'three';
import type { Cloth, Look, MeshData, Vec3 } from '../../../proto/js/messages.js';
import { corners_of } from './border.js';
import { both_diagonals, cells_of } from './cells.js';
import { DepthOrder } from './depth_order.js';
import { fabric_material } from './fabric.js';
import type { Cut } from './fabric.js';
import { FreeSpace } from './free_space.js';
import { Hem } from './hem.js';
import { colors_of, finish_of } from './looks.js';
import { even_normals, smooth_normals } from './normals.js';
import { fabric_extent } from './rest_shape.js';
import { round_of } from './round.js';
import { StripeCurves } from './stripe_curves.js';
import { roundness, Subdivision } from './subdivision.js';
import { weave_of } from './weave.js';
import type { Weave } from './weave.js';
import { WeftWays } from './weft_ways.js';

/** Drawn by subdivision; larger meshes are fine enough by themselves. Quickly drawn are fewer, for slow machines. */
const MOST_TRIANGLES = { smooth: 40_000, quick: 8_000 };
const MOST_LEVELS = 2;
/** How far the drawn surface may leave the simulated one, of the distance that contact keeps or of what is free. */
const REACH = 0.45;

/** A cloth's part of the common buffers. */
interface Piece {
  mesh: Mesh<BufferGeometry, MeshPhysicalMaterial>;
  triangles: Uint32Array;
  order: DepthOrder;
  index: BufferAttribute;
  hem: Hem;
  cut: Cut;
  stripes: StripeCurves | null; // if it has any
}

/**
 * The drawn cloths: finer than the simulated ones, through the same particles, with thick edges.
 * All share one buffer of positions and one of normals.
 */
export class ClothMesh {
  readonly group = new Group();
  /** Of the simulated cloths. */
  readonly triangles: Uint32Array;
  /** Those that normals are the means of. */
  private shaded: Uint32Array;
  private positions: BufferAttribute;
  private normals: BufferAttribute;
  private uv: BufferAttribute;
  private fine: Subdivision;
  private pieces: Piece[];
  private weaves = new Map<string, Weave>();
  private weft: WeftWays | null = null; // if a cloth has need of it
  /** How far the surface may leave the simulated one: at particles if it is round, and everywhere now [m]. */
  private largest_reach: Float32Array;
  private reach: Float32Array;
  private edges: Float32Array;
  private space: FreeSpace;

  /**
   * @param quick whether it is to be drawn quickly rather than smoothly
   * @param room  tells how far a place is from any object at least [m]
   */
  constructor(
    private cloths: Cloth[],
    private data: MeshData,
    quick = false,
    private room: (place: Vec3) => number = () => Infinity,
  ) {
    this.triangles = data.triangles;
    const { coarse } = this;
    const cells = cells_of(data.triangles, data.uv);
    this.shaded = both_diagonals(data.triangles, cells);
    const corners = corners_of(data.triangles, data.uv);
    const levels = levels_of(data, quick);
    this.fine = new Subdivision(coarse, data.triangles, cells, corners, levels);
    const hems = this.hems();
    const vertices = hems.reduce((first, hem) => first + hem.vertices, this.fine.vertices);
    const vector = () => new BufferAttribute(new Float32Array(vertices * 3), 3);
    this.positions = vector().setUsage(DynamicDrawUsage);
    this.space = new FreeSpace(this.positions.array as Float32Array, data.restPositions, data.triangles);
    this.normals = vector().setUsage(DynamicDrawUsage);
    this.largest_reach = new Float32Array(coarse);
    this.reach = new Float32Array(this.fine.vertices);
    this.edges = new Float32Array(this.fine.vertices);
    this.uv = new BufferAttribute(new Float32Array(vertices * 2), 2);
    this.pieces = cloths.map((cloth, k) => this.piece(cloth, data, hems[k]));
    const uv = this.uv.array as Float32Array;
    this.fine.interpolate(uv, 2);
    for (const hem of hems) hem.copy(uv, 2);
    this.dress(cloths.map(({ look }) => look));
    this.update(data.restPositions);
  }

  /** Gives each cloth another look. */
  dress(looks: (Look | undefined)[]): void {
    this.undress();
    const colors = colors_of(looks);
    for (const [k, piece] of this.pieces.entries()) {
      const look = looks[k];
      const { weave, edge, stripe } = finish_of(look);
      if (!this.weaves.has(weave)) this.weaves.set(weave, weave_of(weave));
      piece.mesh.material = fabric_material(look, colors[k], this.weaves.get(weave)!, piece.cut);
      if (piece.mesh.material.anisotropy > 0) this.show_weft(piece);
      (piece.index.array as Uint32Array).set(piece.triangles);
      piece.index.needsUpdate = true;
      const { first_vertex, vertices, thickness } = this.cloths[k];
      const half = Math.min(edge, (REACH / 2) * thickness);
      this.edges.fill(half, first_vertex, first_vertex + vertices);
      this.stripe(piece, this.cloths[k], stripe !== undefined);
    }
    this.fine.interpolate(this.edges, 1);
    this.place_weft();
    this.place_stripes();
  }

  /** Gives a cloth's pattern smooth stripes, or leaves it as it is. */
  private stripe(piece: Piece, cloth: Cloth, striped: boolean): void {
    const uv = this.uv.array as Float32Array;
    piece.stripes?.straighten(uv);
    const { rows, columns, first_vertex } = cloth;
    const finer = striped && this.fine.levels > 0 && rows && columns && piece.cut.size;
    const grid = { first_vertex, rows: rows ?? 0, columns: columns ?? 0 };
    const made = new Set(this.triangles_of(cloth).filter((vertex) => vertex >= this.coarse));
    const parts = 2 ** this.fine.levels;
    piece.stripes = finer ? new StripeCurves(grid, Uint32Array.from(made), uv, finer, parts) : null;
    this.uv.needsUpdate = true;
  }

  private place_stripes(): void {
    for (const { stripes } of this.pieces) {
      if (!stripes) continue;
      stripes.place(this.positions.array as Float32Array, this.uv.array as Float32Array);
      this.uv.needsUpdate = true;
    }
  }

  /** How many of the vertices are simulated; they come first. */
  private get coarse(): number {
    return this.data.restPositions.length / 3;
  }

  private show_weft({ mesh }: Piece): void {
    this.weft ??= new WeftWays(this.triangles, this.data.uv, this.positions.count);
    mesh.geometry.setAttribute('weft', this.weft.attribute);
  }

  private place_weft(): void {
    this.weft?.update(this.positions.array as Float32Array, (ways) => {
      this.fine.interpolate(ways, 3);
      for (const { hem } of this.pieces) hem.copy(ways, 3);
    });
  }

  /** @param particles three values per vertex of the simulated cloths [m] */
  update(particles: Float32Array): void {
    const positions = this.positions.array as Float32Array;
    const normals = this.normals.array as Float32Array;
    positions.set(particles);
    const of_particles = normals.subarray(0, particles.length);
    smooth_normals(positions, this.shaded, of_particles);
    if (this.fine.levels > 0) this.limit(even_normals(this.shaded, of_particles));
    this.space.begin();
    this.fine.refine(positions, normals, this.reach, this.free_reach.bind(this));
    for (const { hem } of this.pieces) hem.place(positions, normals, this.edges);
    this.place_weft();
    this.place_stripes();
    this.positions.needsUpdate = this.normals.needsUpdate = true;
  }

  /**
   * Chooses how far the surface may leave the simulated one, by what contact keeps free.
   * @param agreement of the normals around particles
   */
  private limit(agreement: Float32Array): void {
    for (const [k, most] of this.largest_reach.entries()) {
      this.reach[k] = most * roundness(agreement[k]);
    }
  }

  /**
   * How far it may leave the simulated one at an edge, by what is free there at this moment [m].
   * @param way that its middle would go; objects do not count if it leads along or away from them
   */
  private free_reach(from: number, to: number, way: ArrayLike<number>): number {
    const positions = this.positions.array as Float32Array;
    const middle = [0, 1, 2].map((axis) => (positions[from * 3 + axis] + positions[to * 3 + axis]) / 2);
    const here = this.room(middle as Vec3);
    const there = this.room(middle.map((place, axis) => place + way[axis]) as Vec3);
    const room = there > (1 - REACH) * here ? Infinity : here;
    return REACH * Math.min(room, this.space.around(from, to));
  }

  /** Puts cloths that one sees through, and the triangles of each, in order, far ones first. */
  sort(camera: Camera): void {
    const clear = this.pieces.filter(({ mesh }) => mesh.material.transparent);
    const nearness = new Map<Piece, number>();
    for (const piece of clear) {
      const { index, order } = piece;
      nearness.set(piece, order.sort(camera, this.positions.array as Float32Array, index.array as Uint32Array));
      index.needsUpdate = true;
    }
    clear.sort((one, other) => nearness.get(one)! - nearness.get(other)!);
    // Below 1, so that marks come after all of them.
    for (const [place, { mesh }] of clear.entries()) mesh.renderOrder = place / clear.length;
  }

  dispose(): void {
    this.group.removeFromParent();
    this.undress();
    for (const { mesh } of this.pieces) mesh.geometry.dispose();
  }

  private undress(): void {
    for (const { mesh } of this.pieces) mesh.material?.dispose();
    for (const { texture } of this.weaves.values()) texture.dispose();
    this.weaves.clear();
  }

  private hems(): Hem[] {
    let first = this.fine.vertices;
    return this.cloths.map((cloth) => {
      const hem = new Hem(this.triangles_of(cloth), first);
      first += hem.vertices;
      return hem;
    });
  }

  /** A cloth's part of the fine triangles. */
  private triangles_of(cloth: Cloth): Uint32Array {
    const finer = this.fine.triangles.length / this.triangles.length;
    const first = cloth.first_triangle * 3 * finer;
    return this.fine.triangles.subarray(first, first + cloth.triangles * 3 * finer);
  }

  private piece(cloth: Cloth, data: MeshData, hem: Hem): Piece {
    const { uv } = this;
    const [width, height] = fabric_extent(cloth, data);
    const end = cloth.first_vertex + cloth.vertices;
    for (let i = cloth.first_vertex; i < end; i++) {
      uv.setXY(i, data.uv[i * 2] * width, data.uv[i * 2 + 1] * height);
    }
    this.largest_reach.fill(REACH * cloth.thickness, cloth.first_vertex, end);
    const own = this.triangles_of(cloth);
    const triangles = new Uint32Array(own.length + hem.triangles.length);
    triangles.set(own);
    triangles.set(hem.triangles, own.length);
    const index = new BufferAttribute(triangles.slice(), 1).setUsage(DynamicDrawUsage);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', this.positions);
    geometry.setAttribute('normal', this.normals);
    geometry.setAttribute('uv', uv);
    geometry.setIndex(index);
    const mesh = new Mesh<BufferGeometry, MeshPhysicalMaterial>(geometry);
    mesh.castShadow = mesh.receiveShadow = true;
    mesh.frustumCulled = false; // bounds would have to follow each frame
    this.group.add(mesh);
    const cut = cut_of(cloth, data, [width, height]);
    return { mesh, triangles, order: new DepthOrder(triangles), index, hem, cut, stripes: null };
  }
}

/** What a cloth is in its plane. @param extent its width and height [m] */
function cut_of(cloth: Cloth, data: MeshData, extent: [number, number]): Cut {
  if (cloth.rows && cloth.columns) return { size: extent, round: null };
  const first = cloth.first_triangle * 3;
  const round = round_of(data.triangles.subarray(first, first + cloth.triangles * 3), data.uv);
  if (!round) return { size: null, round };
  const scaled = (values: [number, number]) => values.map((value, axis) => value * extent[axis]) as [number, number];
  return { size: extent, round: { center: scaled(round.center), radii: scaled(round.radii) } };
}

/** How often a mesh is subdivided. @param quick whether it is to be drawn quickly rather than smoothly */
export function levels_of({ triangles }: MeshData, quick: boolean): number {
  const most = MOST_TRIANGLES[quick ? 'quick' : 'smooth'];
  let levels = 0;
  while (levels < MOST_LEVELS && (triangles.length / 3) * 4 ** (levels + 1) <= most) levels += 1;
  return levels;
}

/** Exact Delaunay triangulations, meshes and maps, in WebAssembly. */
import type {
  ConstraintsOptions, Crossings, Interpolation, PolygonsOptions, TriangulationArrays, TriangulationOptions,
} from './declarations.js';

/** x0, y0, x1, y1, ... */
export type Coordinates = ArrayLike<number>;
export type ErrorKind = 'internal' | 'usage' | 'input' | 'device' | 'memory' | 'stopped';

/** An error with one of flaunay's own texts. */
export class FlaunayError extends Error {
  constructor(message: string, kind: ErrorKind);
  /** input: bad points; usage: a request without sense; memory: too little of it; internal: please report it. */
  readonly kind: ErrorKind;
}

/** Delaunator's class: arrays of its types, in its orientation and order, which are the caller's own. */
export default class Delaunator<T extends Coordinates = Coordinates> {
  static from<P>(points: ArrayLike<P>, getX?: (point: P) => number, getY?: (point: P) => number):
    Delaunator<Float64Array>;
  constructor(coords: T);
  readonly coords: T;
  /** 3 points per triangle. */
  readonly triangles: Uint32Array;
  /** Halfedge i begins at point triangles[i]; halfedges[i] is its twin, -1 on the hull. */
  readonly halfedges: Int32Array;
  /** The points on the hull, in order. */
  readonly hull: Uint32Array;
  readonly trianglesLen: number;
  /** Triangulates anew, after coords was changed in place. */
  update(): void;
}

/**
 * The arrays of triangulations are views of the module's memory, without a copy. A view is valid until the object is
 * freed, or until any call lets that memory grow: then its length is 0. So read the property again after other calls,
 * or keep a copy: `triangulation.triangles.slice()`.
 */
declare interface Mesh extends TriangulationArrays {}
declare abstract class Mesh {
  /** The number of points of all sets. */
  readonly pointCount: number;
  /** Set s has triangles [triangleOffsets[s], triangleOffsets[s + 1]). */
  readonly triangleOffsets: Uint32Array;
  readonly hullOffsets: Uint32Array;
  /** Frees the memory; otherwise it is freed with the object, whenever that is. */
  free(): void;
}

/** Neighbours are always computed, halfedges unless they are refused, and areas if they are asked for. */
export interface MeshOptions extends Omit<TriangulationOptions, 'neighbors'> {}

export interface SetOptions extends MeshOptions {
  /** Many sets at once: set s has points [offsets[s], offsets[s + 1]). */
  offsets?: ArrayLike<number>;
}

export interface QueryOptions {
  /** The queries of set s are [offsets[s], offsets[s + 1]). */
  offsets?: ArrayLike<number>;
}

export interface InterpolationOptions extends QueryOptions {
  /** 'sibson' by default. */
  method?: Interpolation;
  /** Numbers per point; 1 by default. */
  columns?: number;
  /** The value outside of the hull; NaN by default. */
  fill?: number;
}

export class Triangulation extends Mesh {
  static from<P>(points: ArrayLike<P>, getX?: (point: P) => number, getY?: (point: P) => number,
    options?: SetOptions): Triangulation;
  /** Triangulates many sets in one call. */
  static batch(sets: Coordinates[], options?: MeshOptions): Triangulation;
  constructor(coords: Coordinates, options?: SetOptions);
  readonly coords: Float64Array;
  /** The Voronoi diagram, whose cells may be unbounded. */
  voronoi(): Voronoi;
  /** The Voronoi cells in [xmin, ymin, xmax, ymax], or in a convex polygon: its corners, counter-clockwise. */
  clippedVoronoi(bounds: Coordinates): ClippedVoronoi;
  /** The triangle at this place, -1 outside. */
  locate(x: number, y: number): number;
  locate(queries: Coordinates, options?: QueryOptions): Int32Array;
  /** The point nearest to this place. */
  nearest(x: number, y: number): number;
  nearest(queries: Coordinates, options?: QueryOptions): Int32Array;
  /** Values between points, `columns` per query. */
  interpolate(values: ArrayLike<number>, queries: Coordinates, options?: InterpolationOptions): Float64Array;
}

export interface Voronoi {
  /** x and y per triangle. */
  readonly circumcentres: Float64Array;
  /** The cell of point i has corners [offsets[i], offsets[i + 1]) of cells. */
  readonly offsets: Int32Array;
  /** Triangles, counter-clockwise around each point. */
  readonly cells: Int32Array;
  /** One per point: 1 if its cell is unbounded. */
  readonly unbounded: Uint8Array;
  free(): void;
}

export interface ClippedVoronoi {
  /** x and y per vertex. */
  readonly vertices: Float64Array;
  /** The cell of point i has vertices [offsets[i], offsets[i + 1]). */
  readonly offsets: Int32Array;
  readonly areas: Float64Array;
  /** x and y per point. */
  readonly centroids: Float64Array;
  /** The vertices of the cell of point i, counter-clockwise. */
  cell(i: number): Float64Array;
  free(): void;
}

/** By default only what is inside by the even-odd rule is kept. */
export interface PolygonOptions extends MeshOptions, PolygonsOptions {}

/** By default crossings are errors, and all triangles are kept. */
export interface ConstraintOptions extends MeshOptions, ConstraintsOptions {
  /** 2 points per segment. */
  segments?: ArrayLike<number>;
  /** x and y per hole: what this place is in is left out. */
  holes?: Coordinates;
  offsets?: ArrayLike<number>;
  holeOffsets?: ArrayLike<number>;
}

/** A triangulation with segments as edges. Halfedges and neighbours are -1 where triangles are left out. */
export class ConstrainedTriangulation extends Mesh {
  constructor(coords: Coordinates, options?: ConstraintOptions);
  /**
   * The insides of polygons, each a list of rings of [x, y], as in a MultiPolygon of GeoJSON: points are numbered in
   * their order. Of a map, `polygons` says which of them a triangle is in.
   */
  static polygons(polygons: ArrayLike<number>[][][], options?: PolygonOptions):
    ConstrainedTriangulation;
  /** x and y of points that crossings have added, whose numbers follow those of the given points. */
  readonly addedPoints: Float64Array;
  /** Set s has added points [addedOffsets[s], addedOffsets[s + 1]). */
  readonly addedOffsets: Uint32Array;
  /** 2 points per edge that segments are made of. */
  readonly constraintEdges: Int32Array;
  /** One per such edge: its segment. */
  readonly edgeSegments: Int32Array;
  /** Segment i has pieces [pieceOffsets[i], pieceOffsets[i + 1]), from its lexicographically smaller end. */
  readonly pieceOffsets: Int32Array;
  /** 2 per piece: it has the edges [first, second) of constraintEdges. */
  readonly pieceEdges: Int32Array;
  /** 3 per triangle: 1 if the edge opposite to the corner is a constraint. */
  readonly constrained: Uint8Array;
  readonly depths: Int32Array;
  readonly regions: Int32Array;
  readonly polygons: Int32Array;
}

/** Views, valid until the next call. */
export interface Changes {
  /** The number of the first point that was inserted; the others follow it. */
  firstPoint: number;
  /** For each point inserted or moved the smallest number of a point in its place. */
  representatives: Int32Array;
  /** The rows whose triangles are gone. */
  removed: Int32Array;
  /** The rows that have new triangles, and the 3 corners of each. */
  made: Int32Array;
  madeCorners: Int32Array;
  /** Whether all points were triangulated anew. */
  isAnew: boolean;
}

/** A triangulation whose points are inserted, removed and moved. Points keep their numbers, triangles their rows. */
export class DynamicTriangulation {
  constructor(coords: Coordinates, options?: {segments?: ArrayLike<number>; crossings?: Crossings});
  /** Inserts points and returns the number of the first; the others follow it. */
  insert(coords: Coordinates): number;
  remove(points: ArrayLike<number>): void;
  /** Moves points to places: x and y per point. */
  move(points: ArrayLike<number>, coords: Coordinates): void;
  /** What the last of these calls has changed. */
  readonly changes: Changes;
  /** One more than the largest number that a point has had. */
  readonly numbers: number;
  readonly pointCount: number;
  readonly triangleCount: number;
  has(point: number): boolean;
  /** The corners of the triangle in each row and the rows beside it; -1 in rows without one. Views, as above. */
  rows(): {triangles: Int32Array; neighbors: Int32Array};
  /** x and y per number; NaN for points that were removed. */
  coordinates(): Float64Array;
  /** The edges that segments are made of, 2 points each, and the segment of each. Views, as above. */
  constraints(): {edges: Int32Array; segments: Int32Array};
  free(): void;
}

/**
 * Finds the edges of any triangulation, such as one of delaunator, that are not Delaunay, exactly: 1 for each halfedge
 * beyond which a vertex lies inside the circumcircle of its triangle.
 */
export function wrongEdges(coords: Coordinates, triangles: ArrayLike<number>, halfedges: ArrayLike<number>): Uint8Array;

/** The version of the library. */
export function version(): string;

/** For 'flaunay/flaunay.js' alone, which is not ready when it is imported: loads flaunay.wasm, from this address. */
export function init(source?: string | URL): Promise<void>;
/** For 'flaunay/flaunay.js' alone: makes it ready at once, from a compiled flaunay.wasm. */
export function start(module: WebAssembly.Module): void;

declare global {
  // Of lib.dom, which programs for Node may do without.
  interface URL {}
  namespace WebAssembly {
    interface Module {}
  }
}

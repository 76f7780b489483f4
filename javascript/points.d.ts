/** What flaunay/points has of flaunay. */
import type {Coordinates, MeshOptions, SetOptions, Triangulation as Whole} from './index.js';

export {
  ClippedVoronoi, Coordinates, ErrorKind, FlaunayError, MeshOptions, QueryOptions, SetOptions, Voronoi, default, ready,
  version, wrongEdges,
} from './index.js';

/** As that of flaunay, without `interpolate`. */
export interface Triangulation extends Omit<Whole, 'interpolate'> {}
export const Triangulation: {
  from<P>(points: ArrayLike<P>, getX?: (point: P) => number, getY?: (point: P) => number,
    options?: SetOptions): Triangulation;
  batch(sets: Coordinates[], options?: MeshOptions): Triangulation;
  new(coords: Coordinates, options?: SetOptions): Triangulation;
};

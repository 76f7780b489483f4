/** What flaunay/points has of flaunay. */
export {
  ClippedVoronoi, Coordinates, ErrorKind, FlaunayError, MeshOptions, QueryOptions, SetOptions, Triangulation, Voronoi,
  default, version, wrongEdges,
} from './flaunay.js';

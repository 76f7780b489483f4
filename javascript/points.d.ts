/** What flaunay/points has of flaunay. */
export {
  ClippedVoronoi, Coordinates, ErrorKind, FlaunayError, MeshOptions, QueryOptions, SetOptions, Triangulation, Voronoi,
  default, ready, version, wrongEdges,
} from './index.js';

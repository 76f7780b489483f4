// As index.js, for points.wasm, whose size is 40 % of it: points, Voronoi diagrams and queries.
import {init} from './flaunay.js';

await init(new URL('points.wasm', import.meta.url));

export {default, FlaunayError, Triangulation, version, wrongEdges} from './flaunay.js';

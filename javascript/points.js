// As index.js, for points.wasm, which is half as large: points, Voronoi diagrams and queries.
import {init} from './library.js';

export {default, FlaunayError, Triangulation, version, wrongEdges} from './library.js';
export const ready = init(() => new URL('points.wasm', import.meta.url));

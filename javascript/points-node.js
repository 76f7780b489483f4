// As node.js, for points.wasm, which is half as large: points, Voronoi diagrams and queries.
import {readFileSync} from 'node:fs';
import {startFile} from './library.js';

export {default, FlaunayError, Triangulation, version, wrongEdges} from './library.js';
export const ready = startFile(() => new URL('points.wasm', import.meta.url), readFileSync);

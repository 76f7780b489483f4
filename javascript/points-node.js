// As node.js, for points.wasm, whose size is 40 % of it: points, Voronoi diagrams and queries.
import {readFileSync} from 'node:fs';
import {start} from './flaunay.js';

start(new WebAssembly.Module(readFileSync(new URL('points.wasm', import.meta.url))));

export {default, FlaunayError, Triangulation, version, wrongEdges} from './flaunay.js';

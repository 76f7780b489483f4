// As node.js, for points.wasm, which is half as large: points, Voronoi diagrams and queries.
import {readFileSync} from 'node:fs';
import {start} from './library.js';

start(new WebAssembly.Module(readFileSync(new URL('points.wasm', import.meta.url))));

export {default, FlaunayError, Triangulation, version, wrongEdges} from './library.js';
export const ready = Promise.resolve();

// For Node, Deno and Bun: the module is read and compiled at once.
import {readFileSync} from 'node:fs';
import {start} from './flaunay.js';

start(new WebAssembly.Module(readFileSync(new URL('flaunay.wasm', import.meta.url))));

export * from './flaunay.js';
export {default} from './flaunay.js';
export const ready = Promise.resolve();

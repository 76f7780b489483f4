// For Node, Deno and Bun: the module is read and compiled at once.
import {readFileSync} from 'node:fs';
import {startFile} from './library.js';

export * from './flaunay.js';
export {default} from './flaunay.js';
export const ready = startFile(() => new URL('flaunay.wasm', import.meta.url), readFileSync);

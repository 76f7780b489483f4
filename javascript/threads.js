// As index.js, with as many threads as there are processors.
import make from './threads/browser.mjs';
import {startThreads} from './flaunay.js';

export * from './flaunay.js';
export {default} from './flaunay.js';
export const ready = startThreads(() => new URL('threads/browser.wasm', import.meta.url), make);

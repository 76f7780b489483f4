// For browsers and what builds for them: importing begins to load the module. Not all bundles can wait for it by
// top-level `await`.
import {init} from './flaunay.js';

export * from './flaunay.js';
export {default} from './flaunay.js';
export const ready = init();

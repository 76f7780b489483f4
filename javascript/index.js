// For browsers and what builds for them: importing waits until the module is loaded.
import {init} from './flaunay.js';

await init();

export * from './flaunay.js';
export {default} from './flaunay.js';

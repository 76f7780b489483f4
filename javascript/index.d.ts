export * from './flaunay.js';
export {default} from './flaunay.js';

/**
 * Fulfilled when the WebAssembly module is loaded: at once in Node, Deno and Bun. Elsewhere nothing works before. If it
 * is rejected, all calls throw its error.
 */
export const ready: Promise<void>;

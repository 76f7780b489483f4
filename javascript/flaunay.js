// The library without a module: ready after `await init()`, or after `start(module)`.
import * as library from './library.js';

export * from './library.js';
export {default} from './library.js';

/**
 * Loads the module and makes the library ready. source: its address; otherwise it lies beside this file.
 * @param {string | URL} [source]
 */
export function init(source = () => new URL('flaunay.wasm', import.meta.url)) {
  return library.init(source);
}

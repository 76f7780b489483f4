// As index.js, with as many threads as there are processors.
import make from './threads/browser.mjs';
import {FlaunayError, startThreads} from './flaunay.js';

if (!globalThis.crossOriginIsolated) {
  throw new FlaunayError(
    'flaunay/threads needs a page that is cross-origin isolated, by the headers Cross-Origin-Opener-Policy: same-origin ' +
      'and Cross-Origin-Embedder-Policy: require-corp',
    'usage',
  );
}

export * from './flaunay.js';
export {default} from './flaunay.js';
export const ready = startThreads(make);

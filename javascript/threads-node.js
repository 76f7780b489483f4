// As node.js, with as many threads as there are processors.
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {startThreads} from './flaunay.js';

const {PThread} = await startThreads(() => new URL('threads/browser.wasm', import.meta.url), (settings, address) => {
  const make = createRequire(import.meta.url)('./threads/node.js');
  return make(Object.assign(settings, {wasmBinary: readFileSync(address)})); // it would be fetched
});
// They wait for work, which is no reason for the process not to end.
for (const worker of [...PThread.unusedWorkers, ...PThread.runningWorkers]) worker.unref();

export * from './flaunay.js';
export {default} from './flaunay.js';
export const ready = Promise.resolve();

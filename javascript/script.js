// What esbuild makes flaunay.min.js of: one script for pages without modules, with points.wasm inside it. Its bytes are
// written by two digits, since Brotli and gzip find less in Base64.
import hex from './points.hex';
import {startFile} from './library.js';

const digit = (code) => (code < 58 ? code - 48 : code - 87);
const bytes = new Uint8Array(hex.length / 2);
for (let i = 0; i < bytes.length; i++) bytes[i] = 16 * digit(hex.charCodeAt(2 * i)) + digit(hex.charCodeAt(2 * i + 1));

export {default as Delaunator, FlaunayError, Triangulation, version, wrongEdges} from './library.js';
export const ready = startFile('flaunay.min.js', () => bytes);

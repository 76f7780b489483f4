// Points of tests/data and exact helpers for tests.
import {readFileSync} from 'node:fs';

/** The folder of files. */
export const DATA = new URL('../../tests/data/', import.meta.url);

/** Points of a file of text: x0, y0, x1, y1, ... */
export function readPoints(name) {
  const text = readFileSync(new URL(name, DATA), 'utf8').replaceAll(/#.*/g, '');
  const rows = text.split('\n').filter((line) => line.trim() !== '').map((line) => line.trim().split(/\s+/).map(Number));
  return rows.flatMap(([x, y]) => [x, y]);
}

/** Random numbers from a seed, the same everywhere (mulberry32). */
export function random(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), seed | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

export function uniform(n, seed = 1) {
  return Float64Array.from({length: 2 * n}, random(seed));
}

export function pairs(coords) {
  return Array.from({length: coords.length / 2}, (_, i) => [coords[2 * i], coords[2 * i + 1]]);
}

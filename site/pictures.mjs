// Draws the first page's picture, site/pictures/{delaunator,flaunay}.svg: the points of a circle in two turns, and the
// edges that are wrong by robust-predicates in red. Fails if the page says another number of them. PACKAGE: the folder
// that scripts/javascript.sh makes.
//
//   node site/pictures.mjs PACKAGE
import assert from 'node:assert/strict';
import {readFileSync, writeFileSync} from 'node:fs';
import {resolve} from 'node:path';
import {pathToFileURL} from 'node:url';

import Peer from './vendor/delaunator/index.js';
import {meshOf, wrongEdges} from './live/wrong.js';

const {default: Delaunator} = await import(pathToFileURL(resolve(process.argv[2], 'points-node.js')));

// By the sine and cosine of angles up to 4 pi: the second turn's points are up to 2e-15 beside those of the first.
const PER_TURN = 36;
const coords = new Float64Array(4 * PER_TURN);
for (let i = 0; i < 2 * PER_TURN; i++) {
  const angle = (2 * Math.PI * i) / PER_TURN;
  coords.set([Math.cos(angle), Math.sin(angle)], 2 * i);
}

const number = (value) => String(Math.round(1000 * value) / 10);
const place = (i) => `${number(coords[2 * i])} ${number(-coords[2 * i + 1])}`;

const text = readFileSync(new URL('index.md', import.meta.url), 'utf8');
const said = {
  delaunator: [/with (\d+) red edges/, />(\d+) wrong edges</].map((pattern) => Number(pattern.exec(text)[1])), flaunay: [0],
};
const leftOut = Number(/leaves (\d+) out/.exec(text)[1]);

for (const [name, {triangles, halfedges}] of [['delaunator', new Peer(coords)], ['flaunay', new Delaunator(coords)]]) {
  const wrong = wrongEdges(coords, meshOf({triangles, halfedges}));
  for (const count of said[name]) assert.equal(wrong.length / 2, count, `${name}: wrong edges`);
  if (name === 'delaunator') assert.equal(2 * PER_TURN - new Set(triangles).size, leftOut, 'points that are left out');
  let faces = '', area = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = triangles.subarray(t, t + 3);
    faces += `<path d="M${place(a)}L${place(b)}L${place(c)}z"/>`;
    area += Math.abs((coords[2 * b] - coords[2 * a]) * (coords[2 * c + 1] - coords[2 * a + 1]) -
      (coords[2 * c] - coords[2 * a]) * (coords[2 * b + 1] - coords[2 * a + 1])) / 2;
  }
  let red = '';
  for (let k = 0; k < wrong.length; k += 2) red += `M${place(wrong[k])}L${place(wrong[k + 1])}`;
  const dots = Array.from({length: PER_TURN}, (_, i) => `M${place(i)}h0`).join('');
  writeFileSync(new URL(`pictures/${name}.svg`, import.meta.url), `<svg xmlns="http://www.w3.org/2000/svg" viewBox="-104 -104 208 208" stroke-linejoin="round" stroke-linecap="round">
<g fill="#4a86b8" fill-opacity=".22" stroke="#4a86b8" stroke-width=".8">${faces}</g>
<path d="${red}" stroke="#e53935" stroke-width="1.6" fill="none"/>
<path d="${dots}" stroke="#4a86b8" stroke-width="4" fill="none"/>
</svg>
`);
  const hull = PER_TURN * Math.sin((2 * Math.PI) / PER_TURN) / 2;
  console.log(`${name}: ${wrong.length / 2} wrong edges, ${triangles.length / 3} triangles, ${(100 * area / hull).toFixed(1)} % of the area`);
}

// A worker: delaunator on the points that the page shows, and an exact check of both triangulations by
// robust-predicates, which shares no code with flaunay.
import Delaunator from '../vendor/delaunator/index.js';
import {meshOf, wrongEdges} from './wrong.js';

function best(runs, work) {
  let result, least = Infinity;
  for (let k = 0; k < runs; k++) {
    const begin = performance.now();
    result = work();
    least = Math.min(least, performance.now() - begin);
  }
  return [result, least];
}

onmessage = ({data: {job, coords, runs, ours, segments}}) => {
  const [delaunator, time] = best(runs, () => new Delaunator(coords));
  const peer = meshOf(delaunator);
  const constrained = new Set();
  for (let k = 0; k < segments.length; k += 2) {
    constrained.add(`${segments[k]},${segments[k + 1]}`).add(`${segments[k + 1]},${segments[k]}`);
  }
  const isConstraint = constrained.size === 0 ? () => false : (a, b) => constrained.has(`${a},${b}`);
  postMessage({job, coords, ...peer, time, wrong: wrongEdges(coords, peer),
    oursWrong: wrongEdges(coords, ours, isConstraint)});
};

// What users write, as scripts/javascript.sh checks it by tsc.
import Delaunator, {
  ClippedVoronoi, ConstrainedTriangulation, DynamicTriangulation, FlaunayError, Triangulation, ready as loaded, wrongEdges,
} from 'flaunay';
import {Triangulation as OfPoints, ready as pointsLoaded} from 'flaunay/points';
import {ready as threadsLoaded} from 'flaunay/threads';
import {init} from 'flaunay/flaunay.js';

const drop: Delaunator<Float64Array> = Delaunator.from([[0, 0], [1, 0], [0, 1]]);
const ofPlain: Delaunator<number[]> = new Delaunator([0, 0, 1, 0, 0, 1]);
const named = Delaunator.from([{x: 1, y: 2}], (p) => p.x, (p) => p.y);
ofPlain.coords[0] = 2;
ofPlain.update();
const triangles: Uint32Array = drop.triangles;
const wrong: Uint8Array = wrongEdges(drop.coords, triangles, named.halfedges);

const mesh = new Triangulation(new Float64Array(10), {areas: true, offsets: [0, 5]});
const cells: ClippedVoronoi = mesh.clippedVoronoi([0, 0, 1, 1]);
const one: number = mesh.locate(0, 0) + mesh.nearest(0, 0) + cells.cell(0)[0] + wrong[0];
const many: Float64Array = mesh.interpolate([1, 2, 3, 4, 5], [0, 0], {method: 'laplace'});
const segments = new ConstrainedTriangulation([0, 0], {segments: [], crossings: 'split'});
const polygons = ConstrainedTriangulation.polygons([[[[0, 0], [1, 0], [0, 1]]]], {map: true});
const moving = new DynamicTriangulation([0, 0]);
moving.move([0], [1, 1]);
const rows: Int32Array = moving.rows().triangles;

// @ts-expect-error There is no such method.
mesh.interpolate([1], [0, 0], {method: 'cubic'});
const ofPoints: OfPoints = OfPoints.batch([[0, 0], [1, 1]]);
const nearest: number = ofPoints.nearest(0, 0);
// @ts-expect-error It has no interpolation.
ofPoints.interpolate([1, 1], [0, 0]);
export async function ready(): Promise<string> {
  await init('flaunay.wasm');
  const both: Promise<void>[] = [loaded, pointsLoaded, threadsLoaded];
  await Promise.all(both);
  try {
    polygons.free();
    return `${one} ${many} ${nearest} ${segments.addedPoints} ${rows}`;
  } catch (error) {
    if (error instanceof FlaunayError && error.kind === 'memory') return error.message;
    throw error;
  }
}

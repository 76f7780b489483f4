// The first page's live triangulation: flaunay on one canvas, delaunator on the same points on another.
import {distributions, generate, parse} from './points.js';
import {Raster} from './raster.js';

const root = document.querySelector('#live');
const control = (name) => root.querySelector(`[name="${name}"]`);
const chosen = (name) => root.querySelector(`[name="${name}"]:checked`).value;
const canvas = root.querySelector('.live-ours');
const drawing = new Raster(canvas);
const peerDrawing = new Raster(root.querySelector('.live-peer'));
const colours = root.querySelector('.live-colours').getContext('2d');
const message = root.querySelector('.live-message');
const isStill = matchMedia('(prefers-reduced-motion: reduce)');

let flaunay; // the module
let coords; // x and y of each point
let values; // what natural neighbours interpolate: a height for each point, which moves with it
let segments = []; // two points each
let polygons = []; // of a file: rings of points, which are filled
let living; // the triangulation that follows the points
let rows; // its triangles and their neighbours, in the module's memory
let view = {scale: 1, x: 0, y: 0}; // pixels = scale * coordinates + (x, y)
let fitted = {}; // the canvas' size for which that was chosen
let selected = 0;
let target = null; // where the selected point is to be in the next frame
let segmentFrom = -1, pointer = null; // a segment that is being drawn: its first point, and where the pointer is
let wrong = new Int32Array(0); // ends of our wrong edges: there are none
let peer = null; // what the worker last said
let isChanged = true; // all has to be drawn anew
let area = null; // what has to be, in pixels, if it is not all
let isScheduled = false, isMoving = false;
let times = {move: 0, draw: 0, frames: [], all: 0};

const checker = new Worker(new URL('checker.js', import.meta.url), {type: 'module'});
let isChecking = false, checked = -1, version = 0;

// ---- The triangulation

function report(error) {
  message.textContent = error?.message ?? '';
}

function build() {
  const made = new flaunay.DynamicTriangulation(coords, segments.length > 0 ? {segments} : {});
  living?.free();
  living = made;
  rows = living.rows();
  isChanged = true;
  changed();
}

// Arrays of the module's memory are empty once it has grown.
function renew() {
  if (rows.triangles.length === 0) rows = living.rows();
}

function changed() {
  version++;
  schedule();
}

// Triangles around the selected point, and from there those beyond their sides for which isNext holds.
function walk(isNext) {
  const {triangles, neighbors} = rows;
  const first = Math.floor(triangles.indexOf(selected) / 3);
  const found = new Set(first < 0 ? [] : [first]);
  for (const t of found) {
    for (let k = 3 * t; k < 3 * t + 3; k++) if (neighbors[k] >= 0 && isNext(neighbors[k], k)) found.add(neighbors[k]);
  }
  return found;
}

// Makes the area contain the triangles around the selected point: all others stay when it moves.
function includeStar() {
  area ??= {left: Infinity, top: Infinity, right: -Infinity, bottom: -Infinity};
  const include = (i, margin) => {
    const {x, y} = pixelOf(i);
    area = {
      left: Math.min(area.left, x - margin), top: Math.min(area.top, y - margin),
      right: Math.max(area.right, x + margin), bottom: Math.max(area.bottom, y + margin),
    };
  };
  include(selected, 20 * devicePixelRatio);
  const {triangles} = rows;
  // The side opposite to another corner has the point.
  for (const t of walk((_, k) => triangles[k] !== selected)) {
    for (let k = 3 * t; k < 3 * t + 3; k++) include(triangles[k], 2);
  }
}

// The triangles that can be seen in the area. They are connected, since it is convex.
function trianglesInArea() {
  const {triangles} = rows;
  return walk((t) => {
    const [a, b, c] = [pixelOf(triangles[3 * t]), pixelOf(triangles[3 * t + 1]), pixelOf(triangles[3 * t + 2])];
    return Math.max(a.x, b.x, c.x) > area.left - 4 && Math.min(a.x, b.x, c.x) < area.right + 4 &&
      Math.max(a.y, b.y, c.y) > area.top - 4 && Math.min(a.y, b.y, c.y) < area.bottom + 4;
  });
}

function moveTo(x, y) {
  const before = [coords[2 * selected], coords[2 * selected + 1]];
  renew();
  includeStar();
  coords[2 * selected] = x;
  coords[2 * selected + 1] = y;
  try {
    // The end of a segment cannot be moved alone.
    if (segments.includes(selected)) build();
    else {
      living.move([selected], [x, y]);
      rows = living.rows();
      includeStar();
      changed();
    }
    report(null);
  } catch (error) {
    coords.set(before, 2 * selected);
    report(error);
  }
}

function addSegment(a, b) {
  if (a === b) return;
  segments.push(a, b);
  try {
    build();
    report(null);
  } catch (error) {
    segments.length -= 2;
    report(error);
  }
}

function best(runs, work) {
  let least = Infinity;
  for (let k = 0; k < runs; k++) {
    const begin = performance.now();
    work();
    least = Math.min(least, performance.now() - begin);
  }
  return least;
}

// Few points more often, since engines compile what has run a while.
const runs = () => Math.ceil(100_000 / coords.length);

function load(shapes) {
  const before = {coords, segments, polygons};
  ({coords, segments, polygons} = shapes);
  report(null);
  try {
    build();
  } catch (error) {
    // Segments that cross.
    segments = [];
    try {
      build();
    } catch (other) {
      ({coords, segments, polygons} = before);
      throw other;
    }
    report(new Error(`without the segments: ${error.message}`));
  }
  wrong = new Int32Array(0);
  peer = null;
  segmentFrom = -1;
  times = {move: 0, draw: 0, frames: [], all: 0};
  fit();
  const {width, height} = size();
  values = Float64Array.from({length: coords.length / 2}, (_, i) => {
    const x = pixelOf(i).x / width, y = pixelOf(i).y / height;
    return Math.sin(9 * x) * Math.cos(7 * y) + 0.35 * Math.sin(31 * x + 17 * y);
  });
  selected = nearest(width / 2, height / 2);
  timeAll();
}

function timeAll() {
  times.all = best(runs(), () => new flaunay.default(coords));
}

// ---- Places

function fit() {
  let [x0, y0, x1, y1] = [Infinity, Infinity, -Infinity, -Infinity];
  for (let k = 0; k < coords.length; k += 2) {
    x0 = Math.min(x0, coords[k]);
    x1 = Math.max(x1, coords[k]);
    y0 = Math.min(y0, coords[k + 1]);
    y1 = Math.max(y1, coords[k + 1]);
  }
  const {width, height} = fitted = size();
  const scale = 0.92 * Math.min(width / (x1 - x0 || 1), height / (y1 - y0 || 1));
  view = {scale, x: (width - scale * (x0 + x1)) / 2, y: (height - scale * (y0 + y1)) / 2};
  isChanged = true;
}

function zoom(factor, at) {
  view = {scale: view.scale * factor, x: at.x - factor * (at.x - view.x), y: at.y - factor * (at.y - view.y)};
  isChanged = true;
  schedule();
}

function pixelOf(i) {
  return {x: coords[2 * i] * view.scale + view.x, y: coords[2 * i + 1] * view.scale + view.y};
}

function nearest(x, y, isCandidate = () => true) {
  let found = -1, least = Infinity;
  for (let i = 0; 2 * i < coords.length; i++) {
    const dx = coords[2 * i] * view.scale + view.x - x, dy = coords[2 * i + 1] * view.scale + view.y - y;
    const distance = dx * dx + dy * dy;
    if (distance < least && isCandidate(dx, dy)) {
      least = distance;
      found = i;
    }
  }
  return found;
}

// ---- Drawing

function size() {
  const {clientWidth, clientHeight} = canvas;
  const ratio = Math.min(devicePixelRatio, 2);
  return {width: Math.max(1, Math.round(clientWidth * ratio)), height: Math.max(1, Math.round(clientHeight * ratio))};
}

// 0xbbggrr of colours for each scheme.
const INKS = {
  light: {line: 0x6b4a24, point: 0x000000, wrong: 0x0000d5, segment: 0x007a1e, ring: '#c51162'},
  dark: {line: 0xe0b890, point: 0xffffff, wrong: 0x5050ff, segment: 0x66e07a, ring: '#ff80ab'},
};
const inks = () => INKS[document.body.dataset.mdColorScheme === 'slate' ? 'dark' : 'light'];

function draw() {
  const {width, height} = size();
  if (width !== fitted.width || height !== fitted.height) fit();
  const ink = inks();
  const x = (i) => coords[2 * i] * view.scale + view.x, y = (i) => coords[2 * i + 1] * view.scale + view.y;
  const what = chosen('view');
  // All is drawn if the selected point is in no triangle.
  const only = isChanged || what !== 'edges' ? new Set() : trianglesInArea();
  drawing.begin(width, height, only.size > 0 ? area : null);
  if (what === 'colours') drawColours(width, height);
  else if (isChanged) fillPolygons(width, height);
  renew();
  if (what === 'voronoi') drawVoronoi();
  else drawEdges(drawing, rows, coords, [...only]);
  drawing.ink(ink.line, what === 'colours' ? 0.3 : 1);
  if (what === 'voronoi' && coords.length < 60_000) {
    for (let i = 0; 2 * i < coords.length; i++) drawing.dot(x(i), y(i));
    drawing.ink(ink.point);
  }
  for (let k = 0; k < segments.length; k += 2) {
    const [a, b] = [segments[k], segments[k + 1]];
    for (const shift of [-1, 0, 1]) {
      drawing.line(x(a) + shift, y(a), x(b) + shift, y(b));
      drawing.line(x(a), y(a) + shift, x(b), y(b) + shift);
    }
  }
  if (segments.length > 0) drawing.ink(ink.segment);
  drawWrong(drawing, coords, wrong, ink);
  drawing.end();

  const {context} = drawing;
  context.strokeStyle = ink.ring;
  context.lineWidth = 2 * Math.min(devicePixelRatio, 2);
  context.beginPath();
  context.arc(x(selected), y(selected), 3 * context.lineWidth, 0, 2 * Math.PI);
  if (segmentFrom >= 0) {
    context.moveTo(x(segmentFrom), y(segmentFrom));
    const to = pointer ?? pixelOf(selected);
    context.lineTo(to.x, to.y);
  }
  context.stroke();
}

// An edge is drawn with the second of its triangles, at the hull with the only one. only: all, if there are none.
function drawEdges(raster, {triangles, neighbors}, places, only = []) {
  const {scale, x, y} = view;
  const count = only.length || triangles.length / 3;
  for (let j = 0; j < count; j++) {
    const t = only.length > 0 ? only[j] : j, k = 3 * t;
    const a = 2 * triangles[k], b = 2 * triangles[k + 1], c = 2 * triangles[k + 2];
    if (a < 0) continue;
    const ax = scale * places[a] + x, ay = scale * places[a + 1] + y;
    const bx = scale * places[b] + x, by = scale * places[b + 1] + y;
    const cx = scale * places[c] + x, cy = scale * places[c + 1] + y;
    if (neighbors[k] < t) raster.line(bx, by, cx, cy);
    if (neighbors[k + 1] < t) raster.line(cx, cy, ax, ay);
    if (neighbors[k + 2] < t) raster.line(ax, ay, bx, by);
  }
}

function drawWrong(raster, places, edges, ink) {
  const {scale, x, y} = view;
  for (let k = 0; k < edges.length; k += 2) {
    const a = edges[k], b = edges[k + 1];
    raster.line(scale * places[2 * a] + x, scale * places[2 * a + 1] + y, scale * places[2 * b] + x,
      scale * places[2 * b + 1] + y);
  }
  if (edges.length > 0) raster.ink(ink.wrong);
}

// Centres of circles of neighbouring triangles are joined; at the hull, a line goes far out.
function drawVoronoi() {
  const {triangles, neighbors} = rows;
  const {scale, x, y} = view;
  const centre = new Float64Array(2 * triangles.length / 3);
  for (let t = 0; 3 * t < triangles.length; t++) {
    const a = triangles[3 * t], b = triangles[3 * t + 1], c = triangles[3 * t + 2];
    if (a < 0) continue;
    const ax = coords[2 * a], ay = coords[2 * a + 1];
    const bx = coords[2 * b] - ax, by = coords[2 * b + 1] - ay, cx = coords[2 * c] - ax, cy = coords[2 * c + 1] - ay;
    const area = 2 * (bx * cy - by * cx), bb = bx * bx + by * by, cc = cx * cx + cy * cy;
    centre[2 * t] = scale * (ax + (cy * bb - by * cc) / area) + x;
    centre[2 * t + 1] = scale * (ay + (bx * cc - cx * bb) / area) + y;
  }
  for (let t = 0; 3 * t < triangles.length; t++) {
    if (triangles[3 * t] < 0) continue;
    for (let k = 0; k < 3; k++) {
      const other = neighbors[3 * t + k];
      if (other > t) drawing.line(centre[2 * t], centre[2 * t + 1], centre[2 * other], centre[2 * other + 1]);
      if (other >= 0) continue;
      const a = triangles[3 * t + ((k + 1) % 3)], b = triangles[3 * t + ((k + 2) % 3)];
      const dx = coords[2 * b + 1] - coords[2 * a + 1], dy = coords[2 * a] - coords[2 * b];
      const far = 3 * (canvas.width + canvas.height) / (Math.hypot(dx, dy) || 1);
      drawing.line(centre[2 * t], centre[2 * t + 1], centre[2 * t] + far * dx, centre[2 * t + 1] + far * dy);
    }
  }
}

// A picture with a pixel for each few of the canvas, which the browser enlarges.
function drawColours(width, height) {
  const step = Math.max(2, Math.ceil(Math.sqrt((width * height) / (isMoving ? 10_000 : 40_000))));
  const columns = Math.ceil(width / step), lines = Math.ceil(height / step);
  const places = new Float64Array(2 * columns * lines);
  for (let k = 0; k < columns * lines; k++) {
    places[2 * k] = (((k % columns) + 0.5) * step - view.x) / view.scale;
    places[2 * k + 1] = ((Math.floor(k / columns) + 0.5) * step - view.y) / view.scale;
  }
  const mesh = new flaunay.Triangulation(coords);
  const heights = mesh.interpolate(values, places, {method: 'sibson'});
  mesh.free();
  colours.canvas.width = columns;
  colours.canvas.height = lines;
  const image = colours.createImageData(columns, lines);
  for (let k = 0; k < heights.length; k++) {
    const h = Math.min(1, Math.max(0, (heights[k] + 1.35) / 2.7));
    // From blue over green to yellow.
    if (!Number.isNaN(heights[k])) image.data.set([60 + 190 * h * h, 70 + 150 * h, 150 - 100 * h * h, 255], 4 * k);
  }
  colours.putImageData(image, 0, 0);
}

function fillPolygons(width, height) {
  colours.canvas.width = polygons.length > 0 ? width : 1;
  colours.canvas.height = polygons.length > 0 ? height : 1;
  for (const [p, rings] of polygons.entries()) {
    colours.beginPath();
    for (const ring of rings) {
      for (const [k, i] of ring.entries()) colours[k === 0 ? 'moveTo' : 'lineTo'](pixelOf(i).x, pixelOf(i).y);
    }
    // Hues that differ between any few polygons in a row.
    colours.fillStyle = `hsl(${137.5 * p} 60% 55% / 50%)`;
    colours.fill('evenodd');
  }
}

function drawPeer() {
  const {width, height} = size();
  peerDrawing.begin(width, height);
  if (peer) {
    drawEdges(peerDrawing, peer, peer.coords);
    peerDrawing.ink(inks().line);
    drawWrong(peerDrawing, peer.coords, peer.wrong, inks());
  }
  peerDrawing.end();
}

// ---- Frames

function schedule() {
  if (isScheduled || !rows) return;
  isScheduled = true;
  requestAnimationFrame(frame);
}

function frame(now) {
  isScheduled = false;
  const begin = performance.now();
  if (drift) moveAround(now);
  const isMoved = target !== null;
  if (isMoved) moveTo(target.x, target.y);
  target = null;
  const moved = performance.now();
  if (isChanged || area) draw();
  isChanged = false;
  area = null;
  if (isMoved) Object.assign(times, {move: moved - begin, draw: performance.now() - moved});
  if (isMoving || drift) {
    times.frames.push(now);
    if (times.frames.length > 60) times.frames.shift();
    // The next frame is asked for at once, so that the rate is the screen's if the work allows it.
    schedule();
  } else times.frames = [];
  check();
  show();
}

let shown = 0;
function show() {
  const count = living.triangleCount;
  // For tests.
  Object.assign(root.dataset, {
    version, checked, triangles: count, wrong: wrong.length / 2, segments: segments.length / 2, selected,
    place: coords.subarray(2 * selected, 2 * selected + 2), moving: isMoving || drift !== null,
    peerTriangles: peer && peer.triangles.length / 3, peerWrong: peer && peer.wrong.length / 2,
  });
  if (performance.now() - shown < 200 && (isMoving || drift)) return;
  shown = performance.now();
  const {frames} = times;
  const rate = frames.length > 5 ? (1000 * (frames.length - 1)) / (frames.at(-1) - frames[0]) : 0;
  Object.assign(root.dataset, {rate: rate.toFixed(1), move: times.move.toFixed(2), draw: times.draw.toFixed(2)});
  const ms = (time) => `${time.toFixed(time < 10 ? 2 : 1)} ms`;
  const rateText = rate > 0 ? `, ${rate.toFixed(0)} frames per second` : '';
  control('times').textContent = times.move + times.draw === 0 ? 'Drag a point to see frame times.'
    : `Last move ${ms(times.move)}, drawing ${ms(times.draw)}${rateText}`;
  control('ours').innerHTML = `${countText(count, 'triangle')}, ${edgesText(checked < 0 ? null : wrong)}; all
    anew in ${ms(times.all)}`;
  control('peer').innerHTML = peer ? `${countText(peer.triangles.length / 3, 'triangle')},
    ${edgesText(peer.wrong)}${segments.length > 0 ? ', without the segments' : ''}; all anew in ${ms(peer.time)}`
    : 'at work';
}

function countText(count, what) {
  return `${count.toLocaleString('en')} ${what}${count === 1 ? '' : 's'}`;
}

function edgesText(edges) {
  if (!edges) return 'being checked';
  const text = countText(edges.length / 2, 'wrong edge');
  return edges.length === 0 ? text : `<span class="live-wrong">${text}</span>`;
}

function check() {
  // Many points are checked when they are at rest.
  if (isChecking || checked === version || (coords.length > 100_000 && (isMoving || drift))) return;
  isChecking = true;
  const edges = segments.length > 0 ? Int32Array.from(living.constraints().edges) : segments;
  renew();
  const given = {
    job: version, coords: coords.slice(), runs: isMoving || drift ? 1 : runs(), segments: edges,
    ours: {triangles: rows.triangles.slice(), neighbors: rows.neighbors.slice()},
  };
  checker.postMessage(given, [given.coords.buffer, given.ours.triangles.buffer, given.ours.neighbors.buffer]);
}

checker.onmessage = ({data}) => {
  isChecking = false;
  // Points may be others since.
  if (data.coords.length === coords.length) {
    checked = data.job;
    peer = data;
    if (wrong.length + data.oursWrong.length > 0) isChanged = true;
    wrong = data.oursWrong;
    drawPeer();
  }
  schedule();
};
checker.onerror = (event) => report(new Error(event.message ?? 'the checker did not start'));

// Until someone takes over, the selected point goes around, unless motion is not wanted.
let drift = null;
function moveAround(now) {
  drift.begin ??= now;
  const angle = (now - drift.begin) / 700;
  if (angle > 4 * Math.PI) drift = null;
  else {
    const radius = drift.radius * Math.min(1, angle);
    target = {x: drift.x + radius * Math.sin(angle), y: drift.y + radius * (1 - Math.cos(angle))};
  }
  if (!drift) settle();
}

function startDrift() {
  if (isStill.matches) return;
  drift = {x: coords[2 * selected], y: coords[2 * selected + 1], radius: size().width / 9 / view.scale};
  schedule();
}

function settle() {
  drift = null;
  isMoving = false;
  // Colours are finer at rest.
  if (chosen('view') === 'colours') isChanged = true;
  schedule();
}

// ---- Pointer and keys

function placeOf(event) {
  const box = canvas.getBoundingClientRect();
  return {
    x: ((event.clientX - box.left) * canvas.width) / box.width,
    y: ((event.clientY - box.top) * canvas.height) / box.height,
  };
}

function coordinatesOf(at) {
  return {x: (at.x - view.x) / view.scale, y: (at.y - view.y) / view.scale};
}

canvas.addEventListener('pointerdown', (event) => {
  if (!rows || event.button !== 0) return;
  drift = null;
  canvas.setPointerCapture(event.pointerId);
  const at = placeOf(event);
  selected = nearest(at.x, at.y);
  isChanged = true;
  if (chosen('tool') === 'segment') {
    segmentFrom = selected;
    pointer = at;
  } else isMoving = true;
  schedule();
});

canvas.addEventListener('pointermove', (event) => {
  const at = placeOf(event);
  if (pointer) {
    pointer = at;
    isChanged = true;
  } else if (isMoving) target = coordinatesOf(at);
  else return;
  schedule();
});

function release(event) {
  if (pointer) {
    const from = segmentFrom;
    segmentFrom = -1;
    pointer = null;
    if (event.type === 'pointerup') {
      const at = placeOf(event);
      selected = nearest(at.x, at.y);
      addSegment(from, selected);
    }
  }
  if (isMoving) timeAll();
  settle();
}
canvas.addEventListener('pointerup', release);
canvas.addEventListener('pointercancel', release);

canvas.addEventListener('wheel', (event) => {
  if (!rows || !event.ctrlKey && !canvas.matches(':focus')) return;
  event.preventDefault();
  zoom(Math.exp(-event.deltaY / 400), placeOf(event));
}, {passive: false});

const DIRECTIONS = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};

canvas.addEventListener('keydown', (event) => {
  if (!rows || event.ctrlKey || event.metaKey || event.altKey) return;
  const direction = DIRECTIONS[event.key], here = pixelOf(selected);
  drift = null;
  if (direction && event.shiftKey) {
    // The nearest point within 45 degrees of the direction.
    const [u, v] = direction;
    const next = nearest(here.x, here.y, (dx, dy) => u * dx + v * dy > Math.abs(v * dx - u * dy));
    if (next >= 0) selected = next;
  } else if (direction) {
    const step = 3 * Math.min(devicePixelRatio, 2);
    target = coordinatesOf({x: here.x + step * direction[0], y: here.y + step * direction[1]});
    times.frames = [];
  } else if (event.key === 'Enter') {
    if (segmentFrom < 0) segmentFrom = selected;
    else {
      addSegment(segmentFrom, selected);
      segmentFrom = -1;
    }
  } else if (event.key === 'Escape') segmentFrom = -1;
  else if (event.key === '+' || event.key === '-') zoom(event.key === '+' ? 1.25 : 0.8, here);
  else if (event.key === '0') fit();
  else if (event.key.toLowerCase() === 'v') {
    const all = [...root.querySelectorAll('[name=view]')];
    all[(all.findIndex((one) => one.checked) + 1) % all.length].checked = true;
  } else return;
  event.preventDefault();
  isChanged = true;
  schedule();
});

// ---- Controls

function generateChosen() {
  drift = null;
  const made = generate(control('distribution').value, Number(control('count').value));
  load({coords: made, segments: [], polygons: []});
}

async function read(file) {
  try {
    load(parse(await file.text()));
  } catch (error) {
    report(new Error(`${file.name}: ${error.message}`));
  }
}

control('distribution').append(...distributions.map((name) => new Option(name)));
control('distribution').value = 'tilted grid';
for (const name of ['count', 'distribution']) control(name).addEventListener('change', generateChosen);
for (const one of root.querySelectorAll('[name=view]')) {
  one.addEventListener('change', () => {
    isChanged = true;
    schedule();
  });
}
control('clear').addEventListener('click', () => {
  segments = [];
  build();
  report(null);
});
control('file').addEventListener('change', (event) => event.target.files[0] && read(event.target.files[0]));
// A file that is dropped elsewhere would take the place of the page. Text may be dropped into the search field.
const hasFiles = (event) => event.dataTransfer?.types.includes('Files');
for (const type of ['dragover', 'drop']) addEventListener(type, (event) => hasFiles(event) && event.preventDefault());
root.addEventListener('dragover', (event) => hasFiles(event) && root.classList.add('live-drop'));
root.addEventListener('dragleave', () => root.classList.remove('live-drop'));
root.addEventListener('drop', (event) => {
  if (!hasFiles(event)) return;
  root.classList.remove('live-drop');
  drift = null;
  if (event.dataTransfer.files[0]) read(event.dataTransfer.files[0]);
});

function redraw() {
  isChanged = true;
  schedule();
  requestAnimationFrame(drawPeer);
}
new MutationObserver(redraw).observe(document.body, {attributeFilter: ['data-md-color-scheme']});
new ResizeObserver(redraw).observe(canvas);

// ---- Start

try {
  flaunay = await import('../module/index.js');
  await flaunay.ready;
  // From the address, such as ?points=10000&distribution=circle.
  const asked = new URLSearchParams(location.search);
  for (const name of ['count', 'distribution']) if (asked.has(name)) control(name).value = asked.get(name);
  generateChosen();
  startDrift();
} catch (error) {
  report(new Error(`The triangulation did not start: ${error.message}`));
}

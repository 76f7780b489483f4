// Where points come from: distributions, and files.

// Mulberry32: the same numbers on every machine.
function randomNumbers(seed) {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let x = Math.imul(state ^ (state >>> 15), 1 | state);
    x ^= x + Math.imul(x ^ (x >>> 7), 61 | x);
    return ((x ^ (x >>> 14)) >>> 0) / 2 ** 32;
  };
}

function normal(random) {
  return Math.sqrt(-2 * Math.log(1 - random())) * Math.cos(2 * Math.PI * random());
}

// Each makes point i of n.
const DISTRIBUTIONS = {
  uniform: (random) => [random(), random()],
  normal: (random) => [normal(random), normal(random)],
  clusters(random, i) {
    const angle = 2.4 * (i % 12);
    return [Math.cos(angle) * (i % 12) + 0.6 * normal(random), Math.sin(angle) * (i % 12) + 0.6 * normal(random)];
  },
  kuzmin(random) {
    const u = 0.97 * random(), angle = 2 * Math.PI * random();
    const radius = Math.sqrt(1 / (1 - u) ** 2 - 1);
    return [radius * Math.cos(angle), radius * Math.sin(angle)];
  },
  circle(random, i, n) {
    const angle = (2 * Math.PI * i) / n;
    return [Math.cos(angle), Math.sin(angle)];
  },
  grid(random, i, n) {
    const side = Math.ceil(Math.sqrt(n));
    return [i % side, Math.floor(i / side)];
  },
  'tilted grid'(random, i, n) {
    const side = Math.ceil(Math.sqrt(n)), x = i % side, y = Math.floor(i / side);
    return [0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y];
  },
  spiral: (random, i) => [Math.sqrt(i) * Math.cos(2.399963 * i), Math.sqrt(i) * Math.sin(2.399963 * i)],
};

export const distributions = Object.keys(DISTRIBUTIONS);

export function generate(distribution, n, seed = 1) {
  const random = randomNumbers(seed);
  const coords = new Float64Array(2 * n);
  for (let i = 0; i < n; i++) coords.set(DISTRIBUTIONS[distribution](random, i, n), 2 * i);
  return coords;
}

function* placesOf(geojson) {
  const {type} = geojson;
  if (type === 'FeatureCollection') for (const feature of geojson.features) yield* placesOf(feature);
  else if (type === 'Feature' && geojson.geometry) yield* placesOf(geojson.geometry);
  else if (type === 'GeometryCollection') for (const geometry of geojson.geometries) yield* placesOf(geometry);
  else if (type === 'Point') yield geojson.coordinates;
  else if (type === 'MultiPoint') yield* geojson.coordinates;
}

function* placesOfLines(text) {
  let number = 0, isFirst = true;
  for (const line of text.split(/\r?\n/)) {
    number++;
    if (/^\s*(#|$)/.test(line)) continue;
    const place = line.trim().split(/[\s,;]+/).slice(0, 2).map(Number);
    const isPlace = place.length === 2 && place.every(Number.isFinite);
    // A first line that is not numbers names the columns.
    if (!isPlace && !isFirst) throw new Error(`line ${number}: two numbers are expected, not "${line.slice(0, 40)}"`);
    if (isPlace) yield place;
    isFirst = false;
  }
}

/** The points of a file: GeoJSON, or text with two numbers per line. */
export function parse(text) {
  const places = [...(/^\s*\{/.test(text) ? placesOf(JSON.parse(text)) : placesOfLines(text))];
  if (places.length < 3) throw new Error(`${places.length} points in the file; at least three make a triangle`);
  const wrong = places.findIndex(([x, y]) => !Number.isFinite(x) || !Number.isFinite(y));
  if (wrong >= 0) throw new Error(`point ${wrong} has no two finite numbers`);
  return Float64Array.from(places.flatMap(([x, y]) => [x, y]));
}

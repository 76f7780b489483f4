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

// The length of a row, so that all rows of a grid are full.
function rowLength(n) {
  let length = Math.floor(Math.sqrt(n));
  while (n % length > 0) length--;
  return length;
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
    const row = rowLength(n);
    return [i % row, Math.floor(i / row)];
  },
  'tilted grid'(random, i, n) {
    const row = rowLength(n), x = i % row, y = Math.floor(i / row);
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

// Points, each place once, segments between them, and polygons: rings of points, which end with the first once more.
class Shapes {
  coords = [];
  segments = [];
  polygons = [];
  #numbers = new Map();
  #joined = new Set();

  point(coordinates) {
    const [x, y] = coordinates ?? [], place = `${x},${y}`, count = this.#numbers.size;
    if (!Number.isFinite(x) || !Number.isFinite(y)) throw new Error(`point ${count} has no two finite numbers`);
    if (!this.#numbers.has(place)) {
      this.#numbers.set(place, count);
      this.coords.push(x, -y); // y goes down on screens
    }
    return this.#numbers.get(place);
  }

  line(places) {
    const points = places.map((place) => this.point(place));
    for (let k = 1; k < points.length; k++) {
      const [a, b] = [Math.min(points[k - 1], points[k]), Math.max(points[k - 1], points[k])];
      if (a < b && !this.#joined.has(`${a},${b}`)) this.segments.push(a, b);
      this.#joined.add(`${a},${b}`);
    }
    return points;
  }

  polygon(rings) {
    this.polygons.push(rings.map((ring) => this.line(ring)));
  }

  add({type, features, geometry, geometries, coordinates}) {
    if (type === 'FeatureCollection') for (const feature of features) this.add(feature);
    else if (type === 'Feature' && geometry) this.add(geometry);
    else if (type === 'GeometryCollection') for (const part of geometries) this.add(part);
    else if (type === 'Point') this.point(coordinates);
    else if (type === 'MultiPoint') for (const place of coordinates) this.point(place);
    else if (type === 'LineString') this.line(coordinates);
    else if (type === 'MultiLineString') for (const line of coordinates) this.line(line);
    else if (type === 'Polygon') this.polygon(coordinates);
    else if (type === 'MultiPolygon') for (const rings of coordinates) this.polygon(rings);
  }
}

// What reads the values of lines that are separated as the first one is: by tabs, semicolons, commas, or any spaces. A
// comma between tabs or semicolons is a decimal one.
function readerOf(first) {
  const bare = first.trim().replace(/"[^"]*"/g, '');
  const separator = [...(/[\p{L},]/u.test(first) ? '\t' : ''), ';', ','].find((one) => bare.includes(one));
  const value = new RegExp(`${separator} *("(?:[^"]|"")*" *(?=${separator}|$)|[^${separator}]*)`, 'g');
  const split = (line) => {
    if (!separator) return line.trim().split(/\s*,\s*|\s+/);
    if (!line.includes('"')) return line.split(separator);
    return Array.from((separator + line).matchAll(value), ([, text]) => text);
  };
  return (line) => split(/[;\t]/.test(separator) ? line.replaceAll(',', '.') : line)
    .map((text) => text.trim().replace(/^"(.*)"$/, '$1'));
}

// What x and y are called; the first pair counts that a file has.
const PAIRS = [[/^x$/i, /^y$/i], [/^(lon|lng|long|longitude)$/i, /^(lat|latitude)$/i],
  [/^(e|east|easting)$/i, /^(n|north|northing)$/i]];

function* placesOfLines(text) {
  let number = 0, valuesOf, columns = [0, 1];
  for (const line of text.split(/\r?\n/)) {
    number++;
    if (/^\s*(#|$)/.test(line)) continue;
    const content = line.replace(/;\s*$/, ''), isFirst = !valuesOf;
    valuesOf ??= readerOf(content);
    const values = valuesOf(content);
    const place = columns.map((k) => (values[k] ? Number(values[k]) : NaN));
    const isPlace = place.every(Number.isFinite);
    if (isPlace) yield place;
    else if (isFirst && /\p{L}/u.test(line)) {
      // It names the columns.
      columns = PAIRS.map((pair) => pair.map((names) => values.findIndex((value) => names.test(value))))
        .find((named) => named.every((k) => k >= 0)) ?? columns;
    } else throw new Error(`line ${number}: two numbers are expected, not "${line.slice(0, 40)}"`);
  }
}

function geojsonOf(text) {
  const object = JSON.parse(text);
  if (!GEOJSON.test(object.type)) throw new Error('it is JSON, but no GeoJSON');
  return object;
}
const GEOJSON = /^(FeatureCollection|Feature|GeometryCollection|(Multi)?(Point|LineString|Polygon))$/;

/** The points, segments and polygons of a file: GeoJSON, or text with two numbers per line. */
export function parse(text) {
  const shapes = new Shapes();
  if (/^\s*\{/.test(text)) shapes.add(geojsonOf(text));
  else for (const place of placesOfLines(text)) shapes.point(place);
  const {coords, segments, polygons} = shapes;
  if (coords.length < 6) throw new Error(`distinct points in the file: ${coords.length / 2}; at least three make a triangle`);
  // The determinants of robust-predicates neither overflow nor vanish.
  const largest = coords.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
  if (!(largest > 1e-60 && largest < 1e60)) throw new Error(`coordinates up to ${largest}; the page draws 1e-60 to 1e60`);
  return {coords: Float64Array.from(coords), segments, polygons};
}

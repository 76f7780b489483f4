// The library over its WebAssembly module: flaunay.wasm, or points.wasm, which is smaller. What package.json exports loads
// one of them and passes on what it has. scripts/declare.py writes what it knows of flaunay.h.
import * as c from './declarations.js';

/** An error with one of flaunay's own texts. */
export class FlaunayError extends Error {
  /**
   * @param {string} message
   * @param {string} kind
   */
  constructor(message, kind) {
    super(message);
    this.name = 'FlaunayError';
    this.kind = kind;
  }
}

// ---- The module

let failure; // the first error of a module that could not be loaded
// What only flaunay has, by the functions of C that it calls first.
const MORE = {
  flaunay_locator_interpolate: 'interpolate', flaunay_triangulate_constrained: 'ConstrainedTriangulation',
  flaunay_triangulate_polygons: 'ConstrainedTriangulation', flaunay_dynamic_create: 'DynamicTriangulation',
};
// What takes the place of functions that no module has, or that the one in use does not have.
const LOADING = new Proxy({}, {
  get(none, name) {
    const reasons = wasm === LOADING ? [] : [`${MORE[name] ?? name} is in flaunay, not in flaunay/points`];
    if (failure) reasons.push(`the module could not be loaded: ${failure.message}`);
    throw new FlaunayError(reasons.join('; ') || 'the WebAssembly module is not loaded yet: await `ready` first',
      failure?.kind ?? 'usage');
  },
});
let wasm = LOADING; // its exports
let heap; // views of its memory
let triangulator = 0;
let place = 0; // where calls write pointers to new handles

// The views, made anew when the memory has grown, for which any thread may have been the reason.
function views() {
  const {buffer} = wasm.memory;
  if (heap?.uint8.buffer !== buffer) {
    heap = {
      int8: new Int8Array(buffer), uint8: new Uint8Array(buffer), int32: new Int32Array(buffer),
      uint32: new Uint32Array(buffer), float64: new Float64Array(buffer),
    };
  }
  return heap;
}

// What the C library asks of its system. There are no files, and the environment is empty.
const NOT_SUPPORTED = 52;
const IMPORTS = {
  clock_time_get(id, precision, to) {
    const nanoseconds = performance.now() * 1e6;
    views().uint32[to >>> 2] = nanoseconds;
    views().uint32[(to >>> 2) + 1] = nanoseconds / 2 ** 32;
    return 0;
  },
  environ_sizes_get(count, bytes) {
    views().uint32[count >> 2] = views().uint32[bytes >> 2] = 0;
    return 0;
  },
  environ_get: () => 0,
  proc_exit(code) {
    throw new FlaunayError(`the module ended itself with code ${code}; please report it`, 'internal');
  },
};

// What a module imports.
function importsOf(module) {
  const imports = {};
  for (const {module: from, name} of WebAssembly.Module.imports(module)) {
    (imports[from] ??= {})[name] = IMPORTS[name] ?? (() => NOT_SUPPORTED);
  }
  return imports;
}

// Calls these functions of C from now on.
function use(functions) {
  if (wasm !== LOADING) {
    if (Object.keys(functions).every((name) => name in wasm || !name.startsWith('flaunay_'))) return;
    throw new FlaunayError('flaunay/points was imported before flaunay, which has more: import flaunay first', 'usage');
  }
  try {
    wasm = Object.setPrototypeOf({...functions}, LOADING);
    functions._initialize?.();
    place = wasm.malloc(8);
    triangulator = create(wasm.flaunay_triangulator_create, 0);
  } catch (error) {
    wasm = LOADING;
    throw error;
  }
}

function instantiate(module) {
  use(new WebAssembly.Instance(module, importsOf(module)).exports);
}

// Throws the error of a module that could not be loaded, which later calls repeat.
function fail(error, what, hint = '') {
  const found = error instanceof FlaunayError ? error : new FlaunayError(`${what}: ${error.message}${hint}`, 'usage');
  failure ??= found;
  throw found;
}

/**
 * Makes the library ready from a compiled module, at once.
 * @param {WebAssembly.Module} module
 */
export function start(module) {
  try {
    instantiate(module);
  } catch (error) {
    fail(error, 'the given module');
  }
}

// An address, or that of a file beside the bundle, which a function returns.
function addressOf(source) {
  if (typeof source !== 'function') return source;
  try {
    return source();
  } catch {
    throw new FlaunayError('this bundle has no import.meta.url: import flaunay/flaunay.js and call init(address) or ' +
      'start(module), or bundle as a module', 'usage');
  }
}

// Makes the library ready by what lies at an address; begins at once.
async function loadFrom(source, work) {
  let address;
  try {
    address = addressOf(source);
    return await work(address);
  } catch (error) {
    const hint = typeof source === 'function' ? `; is ${String(address).split('/').pop()} beside the bundle?` : '';
    return fail(error, address, hint);
  }
}

let earlier = Promise.resolve(); // fulfilled when earlier modules are used or have failed

// Modules load at the same time, but are used in the order of calls.
function inTurn(loaded, work) {
  const done = Promise.all([loaded, earlier]).then(([module]) => work(module));
  earlier = Promise.allSettled([earlier, done]);
  return done;
}

async function load(address) {
  const response = await fetch(address);
  if (!response.ok) throw new Error(`${response.status} ${response.statusText}`);
  const isWasm = response.headers.get('Content-Type')?.startsWith('application/wasm');
  const module = await (isWasm ? WebAssembly.compileStreaming(response) : WebAssembly.compile(await response.arrayBuffer()));
  // Chrome before 114 starts nothing of this size at once in a page.
  return WebAssembly.instantiate(module, importsOf(module));
}

/**
 * Loads the module from this address and makes the library ready.
 * @param {string | URL | (() => URL)} source
 */
export function init(source) {
  return loadFrom(source, (address) => inTurn(load(address), ({exports}) => use(exports)));
}

/**
 * Makes the library ready at once from the bytes that `read` returns, as a file for Node.
 * @param {string | (() => URL)} source
 * @param {(address: string | URL) => Uint8Array} read
 */
export function startFile(source, read) {
  return loadFrom(source, (address) => instantiate(new WebAssembly.Module(read(address))));
}

function assertNoneInUse() {
  if (wasm !== LOADING) throw new FlaunayError('flaunay was imported before flaunay/threads: import that alone', 'usage');
}

/**
 * Makes the library ready with threads: of a module that Emscripten's own JavaScript starts, as that makes workers.
 * @param {() => URL} source
 * @param {(settings: object, address: URL) => Promise<object>} make
 */
export function startThreads(source, make) {
  return loadFrom(source, (address) => {
    if (globalThis.crossOriginIsolated === false) {
      throw new FlaunayError('flaunay/threads needs a page that is cross-origin isolated, by the headers ' +
        'Cross-Origin-Opener-Policy: same-origin and Cross-Origin-Embedder-Policy: require-corp', 'usage');
    }
    assertNoneInUse();
    const memory = new WebAssembly.Memory({initial: 256, maximum: 65536, shared: true}), settings = {wasmMemory: memory};
    const made = new Promise((resolve, reject) => {
      const loading = new AbortController();
      make(settings, address).then(resolve, reject).finally(() => loading.abort());
      // Emscripten, which adds its workers to the settings, waits for them without end, and throws what they throw.
      for (const worker of settings.PThread?.unusedWorkers ?? []) {
        worker.addEventListener?.('error', (event) => {
          event.stopImmediatePropagation();
          reject(new FlaunayError('flaunay/threads: a worker failed: ' + (event.message ??
            'are all files of the folder threads there, with the headers of the page?'), 'usage'));
        }, loading);
      }
    });
    return inTurn(made, (module) => {
      assertNoneInUse(); // another module may have been faster
      // It puts an underscore before the names of C.
      const functions = Object.entries(module).filter(([name]) => name.startsWith('_')).map(([name, call]) => [name.slice(1), call]);
      use({memory, ...Object.fromEntries(functions)});
      return module;
    }).catch((error) => {
      settings.PThread?.terminateAllThreads();
      throw error;
    });
  });
}

// ---- Calls

function stringAt(pointer) {
  const end = views().uint8.indexOf(0, pointer);
  return new TextDecoder().decode(views().uint8.slice(pointer, end));
}

function check(status) {
  if (status !== 0) throw new FlaunayError(stringAt(wasm.flaunay_last_error()), c.STATUS[status].replace('error-', ''));
}

function allocate(bytes) {
  const pointer = wasm.malloc(bytes) >>> 0;
  if (pointer === 0) throw new FlaunayError(`no memory for ${bytes} bytes`, 'memory');
  return pointer;
}

// Calls a function whose last argument is where it writes a pointer to a new handle.
function create(make, ...given) {
  check(make(...given, place));
  return views().uint32[place >> 2];
}

const SHIFTS = {int8: 0, uint8: 0, int32: 2, uint32: 2, float64: 3};

function arrayAt(type, pointer, length) {
  const first = pointer >>> SHIFTS[type];
  return views()[type].subarray(first, first + length);
}

// A view that keeps what it belongs to from being collected.
const owners = new WeakMap();
function viewOf(owner, type, pointer, length) {
  const view = arrayAt(type, pointer, length);
  owners.set(view, owner);
  return view;
}

// Memory for the arguments of a call, which ends with it.
class Arguments {
  #pointers = [];

  room(bytes) {
    const pointer = allocate(bytes);
    this.#pointers.push(pointer);
    return pointer;
  }

  // A pointer to the values: a copy, unless they lie in the module's memory; 0 for none.
  array(type, values) {
    if (values === undefined || values === null) return 0;
    if (values.buffer === wasm.memory.buffer && values.constructor === views()[type].constructor) return values.byteOffset;
    const pointer = this.room(Math.max(values.length << SHIFTS[type], 1));
    views()[type].set(values, pointer >>> SHIFTS[type]);
    return pointer;
  }

  // A struct of C with these members, and with its words and flags that are among options.
  struct({words, at, doubles, kinds}, values, options = {}) {
    const pointer = this.room(4 * words);
    const all = arrayAt('uint32', pointer, words).fill(0);
    const put = (name, value) => {
      if (name in doubles) views().float64[(pointer >>> 3) + doubles[name]] = value;
      else all[at[name]] = value;
      const counts = at[`has${name[0].toUpperCase()}${name.slice(1)}`];
      if (counts !== undefined) all[counts] = 1;
    };
    for (const name in values) put(name, values[name]);
    for (const [name, kind] of Object.entries(kinds)) {
      const value = options[name];
      if (value !== undefined) put(name, kind === 'flag' ? Number(value) : enumerator(kind, value));
    }
    return pointer;
  }

  end() {
    for (const pointer of this.#pointers) wasm.free(pointer);
  }
}

function call(work) {
  const given = new Arguments();
  try {
    return work(given);
  } finally {
    given.end();
  }
}

// The members of a struct that C returned.
function membersAt(pointer, {words, at}) {
  const all = arrayAt('uint32', pointer, words);
  return Object.fromEntries(Object.entries(at).map(([name, k]) => [name, all[k]]));
}

// What the words of an enumeration are called, unless by its name.
const CALLED = {
  crossings: 'rule for crossings', interpolation: 'method of interpolation', outside: 'choice of what is left out',
};

function enumerator(kind, value) {
  const words = c[kind.toUpperCase()], found = words.indexOf(value);
  if (found < 0) {
    throw new FlaunayError(`${value} is no ${CALLED[kind] ?? kind.replace('_', ' ')}: ${words.join(', ')}`, 'usage');
  }
  return found;
}

const freed = new FinalizationRegistry(({destroy, pointer}) => wasm[destroy](pointer));

// What a handle of C, or a piece of memory, belongs to.
class Handle {
  #pointer;

  constructor(pointer, destroy) {
    this.#pointer = pointer;
    this.destroy = destroy;
    freed.register(this, {destroy, pointer}, this);
  }

  get pointer() {
    if (this.#pointer === 0) throw new FlaunayError('it was freed', 'usage');
    return this.#pointer;
  }

  free() {
    if (this.#pointer === 0) return;
    freed.unregister(this);
    wasm[this.destroy](this.#pointer);
    this.#pointer = 0;
  }
}

// ---- Points

function coordinatesOf(points, getX, getY) {
  const n = points.length;
  const coords = new Float64Array(2 * n);
  for (let i = 0; i < n; i++) {
    const p = points[i];
    coords[2 * i] = getX(p);
    coords[2 * i + 1] = getY(p);
  }
  return coords;
}

const first = (p) => p[0];
const second = (p) => p[1];

function pointCount(coords) {
  const n = coords.length >> 1;
  if (n < 0) throw new RangeError(`Invalid typed array length: ${n}`);
  if (n > 0 && typeof coords[0] !== 'number') throw new Error('Expected coords to contain numbers.');
  return n;
}

// ---- Triangulations

// The points of a call and where its sets begin.
function pointsOf(given, coords, offsets) {
  const n = pointCount(coords);
  return [given.array('float64', coords), n, given.array('uint32', offsets), offsets ? offsets.length - 1 : 0];
}

function optionsOf(given, parts) {
  return given.struct(c.Options, {parts});
}

// The bits of the arrays that are asked for: neighbours always, half-edges unless they are refused.
function partsOf({halfedges = true, ...others}) {
  const wanted = {...others, halfedges, neighbors: true};
  return Object.entries(c.PART).reduce((bits, [name, bit]) => (wanted[name] ? bits | bit : bits), 0);
}

/** Delaunator's class: arrays of its types, in its orientation and order, which are the caller's own. */
export default class Delaunator {
  static from(points, getX = first, getY = second) {
    return new Delaunator(coordinatesOf(points, getX, getY));
  }

  constructor(coords) {
    this.coords = coords;
    this.update();
  }

  update() {
    call((given) => {
      const {coords} = this, n = pointCount(coords);
      const handle = create(wasm.triangulate, triangulator, given.array('float64', coords), n, 0, 0, c.PART.halfedges);
      // Read where they are, since this takes a good part of the time for a hundred points.
      const {words, at} = c.Mesh, mesh = arrayAt('uint32', wasm.flaunay_triangulation_mesh(handle), words);
      const triangleCount = mesh[at.triangleCount], hullCount = mesh[at.hullCount];
      const triangles = mesh[at.triangles], halfedges = mesh[at.halfedges], hull = mesh[at.hull];
      wasm.turn_clockwise(triangles, halfedges, triangleCount, hull, hullCount);
      this.trianglesLen = 3 * triangleCount;
      this.triangles = arrayAt('uint32', triangles, this.trianglesLen).slice();
      this.halfedges = arrayAt('int32', halfedges, this.trianglesLen).slice();
      this.hull = arrayAt('uint32', hull, hullCount).slice();
      wasm.flaunay_triangulation_destroy(handle);
    });
  }
}

// How many rows of something there are, by the counts that structs of C have.
function rowsIn(counts, row) {
  if (row === 'halfedge') return 3 * counts.triangleCount;
  const of = row.replace('_offset', '');
  return counts[`${of}Count`] + Number(of !== row);
}

// Defines a property for each array of a table. read(object, name): its address, and how many rows of what there are.
function defineArrays(owner, table, read) {
  for (const [name, [type, row, columns]] of Object.entries(table)) {
    const get = function () {
      const [address, count] = read(this, name, row);
      return viewOf(this, type, address, address === 0 ? 0 : columns * count);
    };
    Object.defineProperty(owner.prototype, name, {get, configurable: true});
  }
}

const OFFSETS = {triangleOffsets: ['uint32', 'set_offset', 1], hullOffsets: ['uint32', 'set_offset', 1]};

// The arrays that all triangulations have. They are views of the module's memory.
class Mesh {
  #handle;
  #mesh;

  static {
    defineArrays(this, {...c.TRIANGULATION_ARRAYS, ...OFFSETS}, (mesh, name, row) => {
      void mesh.handle;
      return [mesh.#mesh[name], rowsIn(mesh.#mesh, row)];
    });
  }

  constructor(handle, mesh) {
    this.#handle = handle;
    this.#mesh = membersAt(mesh, c.Mesh);
  }

  get counts() {
    return this.#mesh;
  }

  get handle() {
    return this.#handle.pointer;
  }

  get pointCount() {
    return this.#mesh.pointCount;
  }

  free() {
    this.#handle.free();
  }
}

// A copy of the caller's points that lives as long as what is computed from them.
function keep(coords) {
  const kept = new Handle(allocate(Math.max(8 * coords.length, 1)), 'free');
  views().float64.set(coords, kept.pointer >>> 3);
  return kept;
}

export class Triangulation extends Mesh {
  #coords;
  #offsets;
  #locator;

  static from(points, getX = first, getY = second, given = {}) {
    return new Triangulation(coordinatesOf(points, getX, getY), given);
  }

  /** Triangulates many sets in one call. */
  static batch(sets, given = {}) {
    const offsets = [0];
    for (const coords of sets) offsets.push(offsets.at(-1) + pointCount(coords));
    const all = new Float64Array(2 * offsets.at(-1));
    sets.forEach((coords, s) => all.set(coords, 2 * offsets[s]));
    return new Triangulation(all, {...given, offsets});
  }

  constructor(coords, given = {}) {
    pointCount(coords);
    const kept = keep(coords);
    try {
      const handle = call((passed) => create(wasm.triangulate, triangulator,
        ...pointsOf(passed, arrayAt('float64', kept.pointer, coords.length), given.offsets), partsOf(given)));
      super(new Handle(handle, 'flaunay_triangulation_destroy'), wasm.flaunay_triangulation_mesh(handle));
    } catch (error) {
      kept.free();
      throw error;
    }
    this.#coords = kept;
    this.#offsets = given.offsets && Uint32Array.from(given.offsets);
  }

  get coords() {
    return viewOf(this, 'float64', this.#coords.pointer, 2 * this.pointCount);
  }

  /** The Voronoi diagram, whose cells may be unbounded. */
  voronoi() {
    return new Voronoi(create(wasm.voronoi, triangulator, this.#coords.pointer, this.pointCount,
      this.handle));
  }

  /** The Voronoi cells in [xmin, ymin, xmax, ymax], or in a convex polygon: its corners x0, y0, ..., counter-clockwise. */
  clippedVoronoi(bounds) {
    const [xmin, ymin, xmax, ymax] = bounds;
    const corners = bounds.length === 4 ? [xmin, ymin, xmax, ymin, xmax, ymax, xmin, ymax] : bounds;
    return call((given) => new ClippedVoronoi(create(wasm.clipped_voronoi, triangulator, this.#coords.pointer,
      this.pointCount, this.handle, given.array('float64', corners), corners.length >> 1)));
  }

  // Calls a function of the locator with queries. Results are the caller's own.
  #query(ask, type, queries, offsets, columns = 1) {
    void this.handle;
    return call((given) => {
      const passed = pointsOf(given, queries, offsets);
      this.#locator ??= new Handle(create(wasm.locator, triangulator,
        ...pointsOf(given, this.coords, this.#offsets), this.handle), 'flaunay_locator_destroy');
      const count = passed[1] * columns;
      const results = given.room(Math.max(count << SHIFTS[type], 1));
      check(ask(given, this.#locator.pointer, passed, results));
      return arrayAt(type, results, count).slice();
    });
  }

  /** The triangle of each query, -1 outside. For a place x, y its number. */
  locate(queries, y) {
    if (typeof queries === 'number') return this.locate([queries, y])[0];
    return this.#query((given, locator, passed, results) => wasm.flaunay_locator_locate(locator, ...passed, results),
      'int32', queries, y?.offsets);
  }

  /** The point nearest to each query. For a place x, y its number. */
  nearest(queries, y) {
    if (typeof queries === 'number') return this.nearest([queries, y])[0];
    return this.#query((given, locator, passed, results) => wasm.flaunay_locator_nearest(locator, ...passed, results),
      'int32', queries, y?.offsets);
  }

  /** Values between points, one row of `columns` numbers per query. */
  interpolate(values, queries, {method = 'sibson', columns = 1, fill = NaN, offsets} = {}) {
    if (values.length !== columns * this.pointCount) {
      throw new FlaunayError(`${values.length} values are not ${columns} for each of ${this.pointCount} points`,
        'usage');
    }
    return this.#query((given, locator, passed, results) => wasm.flaunay_locator_interpolate(locator,
      given.array('float64', values), ...passed, given.struct(c.InterpolationOptions, {columns, fill}, {method}), results),
    'float64', queries, offsets, columns);
  }

  free() {
    super.free();
    this.#locator?.free();
    this.#coords.free();
  }
}

// Results whose accessors of C take the handle.
class Result {
  #handle;
  #prefix;

  static define(owner, table) {
    defineArrays(owner, table, (result, name, row) => [
      result.#read(name.replace(/[A-Z]/g, (letter) => `_${letter.toLowerCase()}`)),
      row === 'point_offset' ? result.#read('point_count') + 1 : result.#read(`${row}_count`),
    ]);
  }

  constructor(pointer, prefix) {
    this.#handle = new Handle(pointer, `${prefix}_destroy`);
    this.#prefix = prefix;
  }

  #read(name) {
    return wasm[`${this.#prefix}_${name}`](this.#handle.pointer);
  }

  free() {
    this.#handle.free();
  }
}

class Voronoi extends Result {
  static {
    Result.define(this, c.VORONOI_ARRAYS);
  }

  constructor(pointer) {
    super(pointer, 'flaunay_voronoi');
  }

  get offsets() {
    return this.cellOffsets;
  }
}

class ClippedVoronoi extends Result {
  static {
    Result.define(this, c.CLIPPED_VORONOI_ARRAYS);
  }

  constructor(pointer) {
    super(pointer, 'flaunay_clipped_voronoi');
  }

  /** The vertices of the cell of point i, counter-clockwise. */
  cell(i) {
    const {offsets, vertices} = this;
    return viewOf(this, 'float64', vertices.byteOffset + 16 * offsets[i], 2 * (offsets[i + 1] - offsets[i]));
  }
}

// ---- Constraints

function constraintsOf(passed, given) {
  const {segments = [], holes, holeOffsets} = given;
  return passed.struct(c.Constraints, {
    segments: passed.array('int32', segments),
    segmentCount: segments.length >> 1,
    holes: passed.array('float64', holes),
    holeCount: (holes?.length ?? 0) >> 1,
    holeOffsets: passed.array('uint32', holeOffsets),
  }, given);
}

/** A triangulation with segments as edges. */
export class ConstrainedTriangulation extends Mesh {
  #arrays;

  static {
    defineArrays(this, c.CONSTRAINED_ARRAYS, (mesh, name, row) => {
      void mesh.handle;
      return [mesh.#arrays[name], rowsIn({...mesh.counts, ...mesh.#arrays}, row)];
    });
  }

  /** The insides of polygons: each a list of rings of [x, y], as in a MultiPolygon of GeoJSON. */
  static polygons(polygons, given = {}) {
    const coordinates = [], ringOffsets = [0], polygonOffsets = [0];
    for (const rings of polygons) {
      for (const ring of rings) {
        for (const [x, y] of ring) coordinates.push(x, y);
        ringOffsets.push(coordinates.length >> 1);
      }
      polygonOffsets.push(ringOffsets.length - 1);
    }
    const handle = call((passed) => create(wasm.flaunay_triangulate_polygons, triangulator,
      passed.struct(c.Polygons, {
        coordinates: passed.array('float64', coordinates),
        ringOffsets: passed.array('uint32', ringOffsets),
        ringCount: ringOffsets.length - 1,
        polygonOffsets: passed.array('uint32', polygonOffsets),
        polygonCount: polygons.length,
      }, given), optionsOf(passed, partsOf(given))));
    return new ConstrainedTriangulation(handle);
  }

  constructor(coords, given = {}) {
    const handle = typeof coords === 'number' ? coords : call((passed) => create(
      wasm.flaunay_triangulate_constrained, triangulator, ...pointsOf(passed, coords, given.offsets),
      constraintsOf(passed, given), optionsOf(passed, partsOf(given))));
    super(new Handle(handle, 'flaunay_triangulation_destroy'), wasm.flaunay_triangulation_mesh(handle));
    this.#arrays = membersAt(wasm.flaunay_triangulation_constraints(handle), c.ConstrainedArrays);
  }
}

// ---- Triangulations that change

/** A triangulation whose points are inserted, removed and moved. */
export class DynamicTriangulation {
  #handle;
  #room = null;
  #roomBytes = 0;

  constructor(coords, given = {}) {
    this.#handle = new Handle(call((passed) => {
      const [pointer, n] = pointsOf(passed, coords);
      return create(wasm.flaunay_dynamic_create, triangulator, pointer, n,
        given.segments ? constraintsOf(passed, given) : 0, 0);
    }), 'flaunay_dynamic_destroy');
  }

  // Memory for the arrays of rows and of places, which is used again.
  #results(bytes) {
    if (bytes > this.#roomBytes) {
      this.#room?.free();
      this.#room = null;
      this.#room = new Handle(allocate(2 * bytes), 'free');
      this.#roomBytes = 2 * bytes;
    }
    return this.#room?.pointer ?? 0;
  }

  /** Inserts points and returns the number of the first one; the others follow it. */
  insert(coords) {
    call((given) => {
      const [pointer, m] = pointsOf(given, coords);
      check(wasm.flaunay_dynamic_insert(this.#handle.pointer, pointer, m));
    });
    return this.changes.firstPoint;
  }

  remove(points) {
    call((given) => check(wasm.flaunay_dynamic_remove(this.#handle.pointer, given.array('int32', points),
      points.length)));
  }

  move(points, coords) {
    if (coords.length !== 2 * points.length) {
      throw new FlaunayError(`${coords.length} coordinates are not 2 for each of ${points.length} points`, 'usage');
    }
    call((given) => check(wasm.flaunay_dynamic_move(this.#handle.pointer, given.array('int32', points),
      given.array('float64', coords), points.length)));
  }

  /** What the last insertion, removal or move has changed. */
  get changes() {
    const found = membersAt(wasm.flaunay_dynamic_changes(this.#handle.pointer), c.Changes);
    return {
      firstPoint: found.firstPoint,
      representatives: viewOf(this, 'int32', found.representatives, found.representativeCount),
      removed: viewOf(this, 'int32', found.removed, found.removedCount),
      made: viewOf(this, 'int32', found.made, found.madeCount),
      madeCorners: viewOf(this, 'int32', found.madeCorners, 3 * found.madeCount),
      isAnew: found.isAnew !== 0,
    };
  }

  /** One more than the largest number that a point has had. */
  get numbers() {
    return wasm.flaunay_dynamic_numbers(this.#handle.pointer);
  }

  get pointCount() {
    return wasm.flaunay_dynamic_point_count(this.#handle.pointer);
  }

  get triangleCount() {
    return wasm.flaunay_dynamic_triangle_count(this.#handle.pointer);
  }

  has(point) {
    return wasm.flaunay_dynamic_has_point(this.#handle.pointer, point) !== 0;
  }

  /** The rows: `triangles` with the corners, and `neighbors`; -1 in rows without a triangle. */
  rows() {
    const entries = 3 * wasm.flaunay_dynamic_row_count(this.#handle.pointer);
    const triangles = this.#results(8 * entries);
    const neighbors = triangles + 4 * entries;
    check(wasm.flaunay_dynamic_rows(this.#handle.pointer, triangles, neighbors));
    return {
      triangles: viewOf(this, 'int32', triangles, entries), neighbors: viewOf(this, 'int32', neighbors, entries),
    };
  }

  /** x and y per number; NaN for points that were removed. */
  coordinates() {
    const coords = new Float64Array(2 * this.numbers);
    call((given) => {
      const pointer = given.room(Math.max(8 * coords.length, 1));
      check(wasm.flaunay_dynamic_coordinates(this.#handle.pointer, pointer));
      coords.set(arrayAt('float64', pointer, coords.length));
    });
    return coords;
  }

  /** The edges that segments are made of: `edges`, two points each, and `segments`, the segment of each. */
  constraints() {
    const pointer = wasm.flaunay_dynamic_constraints(this.#handle.pointer);
    if (pointer === 0) check(wasm.flaunay_last_error_status());
    const found = membersAt(pointer, c.LivingConstraints);
    return {
      edges: viewOf(this, 'int32', found.edges, 2 * found.edgeCount),
      segments: viewOf(this, 'int32', found.segments, found.edgeCount),
    };
  }

  free() {
    this.#handle.free();
    this.#room?.free();
  }
}

// ---- Given triangulations

/**
 * Finds the edges of any triangulation that are not Delaunay, exactly: 1 for each halfedge whose triangle's circumcircle
 * has the vertex beyond it inside.
 */
export function wrongEdges(coords, triangles, halfedges) {
  return call((given) => {
    const [pointer, n] = pointsOf(given, coords);
    const t = Math.floor(triangles.length / 3);
    const sides = given.room(Math.max(3 * t, 1));
    check(wasm.flaunay_edge_circles(pointer, n, given.array('int32', triangles), t, given.array('int32', halfedges),
      sides));
    return Uint8Array.from(arrayAt('int8', sides, 3 * t), (side) => Number(side > 0));
  });
}

/** The version of the library. */
export function version() {
  return stringAt(wasm.flaunay_version());
}

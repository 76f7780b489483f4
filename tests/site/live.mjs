// The site's first page in headless Chromium, driven by its DevTools protocol:
//
//   node --experimental-websocket live.mjs ADDRESS FOLDER
//
// What it shows is read back as counts. Writes screenshots to FOLDER, and the measurements there to live.json.
import {strict as assert} from 'node:assert';
import {spawn} from 'node:child_process';
import {mkdirSync, mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {gzipSync} from 'node:zlib';

const [address, folder] = process.argv.slice(2);
mkdirSync(folder, {recursive: true});
const profile = mkdtempSync(`${tmpdir()}/live-`);
const browser = spawn('chromium', ['--headless=new', '--no-sandbox', '--disable-gpu', '--hide-scrollbars',
  '--remote-debugging-port=0', `--user-data-dir=${profile}`, 'about:blank'], {detached: true});
const socket = new WebSocket(await new Promise((found, failed) => {
  let text = '';
  browser.on('exit', () => failed(new Error(`chromium ended: ${text}`)));
  browser.stderr.on('data', (data) => {
    text += data;
    const match = /DevTools listening on (\S+)/.exec(text);
    if (match) found(match[1]);
  });
}));
await new Promise((opened) => socket.addEventListener('open', opened));

let calls = 0;
const waiting = new Map();
const problems = [], requests = [];
socket.addEventListener('message', ({data}) => {
  const {id, error, result, method, params} = JSON.parse(data);
  if (id) {
    const {done, failed} = waiting.get(id);
    if (error) failed(new Error(error.message));
    else done(result);
  } else if (method === 'Runtime.exceptionThrown') {
    problems.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
  } else if (method === 'Runtime.consoleAPICalled' && ['error', 'warning'].includes(params.type)) {
    problems.push(params.args.map(({value, description}) => value ?? description).join(' '));
  } else if (method === 'Log.entryAdded' && params.entry.level === 'error') {
    problems.push(`${params.entry.text} ${params.entry.url ?? ''}`);
  } else if (method === 'Network.requestWillBeSent') requests.push(params.request.url);
});

let session;
function send(method, params = {}, sessionId = session) {
  socket.send(JSON.stringify({id: ++calls, method, params, sessionId}));
  return new Promise((done, failed) => waiting.set(calls, {done, failed}));
}

const pause = (ms) => new Promise((done) => setTimeout(done, ms));

async function evaluate(expression) {
  const {result, exceptionDetails} = await send('Runtime.evaluate',
    {expression, awaitPromise: true, returnByValue: true});
  if (exceptionDetails) throw new Error(exceptionDetails.exception.description);
  return result.value;
}

async function until(what, expression, seconds = 30) {
  for (const end = Date.now() + 1000 * seconds; Date.now() < end; await pause(50)) {
    const value = await evaluate(expression);
    if (value) return value;
  }
  throw new Error(`no ${what}: ${JSON.stringify(await state())} ${problems}`);
}

const state = () => evaluate(`({...document.querySelector('#live').dataset})`);

// All is drawn and checked: a check has ended whose triangles are the latest.
async function settled() {
  // What has been done shows after the page's next frame.
  await evaluate('new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)))');
  return until('end of the checks', `(() => { const d = document.querySelector('#live').dataset;
    return d.checked !== undefined && d.checked === d.version && d.moving === 'false' && {...d}; })()`);
}

async function open(query) {
  await send('Page.navigate', {url: `${address}/index.html?${query}`});
  await until('page', `document.readyState === 'complete' && document.querySelector('#live')?.dataset.version`);
}

async function choose(name, value) {
  await evaluate(`(() => { const one = document.querySelector('#live [name=${name}]');
    if (one.tagName === 'SELECT') one.value = '${value}';
    const target = one.tagName === 'SELECT' ? one : document.querySelector('#live [name=${name}][value=${value}]');
    target.checked = true; target.dispatchEvent(new Event('change')); })()`);
}

const box = () => evaluate(`(() => { document.querySelector('.live-ours').scrollIntoView({block: 'center'});
  const {left, top, width, height} = document.querySelector('.live-ours').getBoundingClientRect();
  return {left, top, width, height}; })()`);

const mouse = (type, x, y) => send('Input.dispatchMouseEvent', {type, x, y, button: 'left', buttons: 1, clickCount: 1});

async function key(name, modifiers = 0) {
  await send('Input.dispatchKeyEvent', {type: 'keyDown', key: name, code: name, modifiers});
  await send('Input.dispatchKeyEvent', {type: 'keyUp', key: name, code: name, modifiers});
}

// Moves a point around for some seconds; returns what the page measured while it went.
async function drag(seconds) {
  const {left, top, width, height} = await box();
  const x = left + width / 2, y = top + height / 2;
  await mouse('mousePressed', x, y);
  const begin = Date.now();
  for (let now = 0; now < 1000 * seconds; now = Date.now() - begin) {
    await mouse('mouseMoved', x + 60 * Math.sin(now / 300), y + 60 * (1 - Math.cos(now / 300)));
    await pause(4);
  }
  const {rate, move, draw} = await state();
  await mouse('mouseReleased', x + 20, y + 30);
  return {frames_per_second: Number(rate), move_ms: Number(move), draw_ms: Number(draw)};
}

async function capture(name, whole = false) {
  const {data} = await send('Page.captureScreenshot', {format: 'png', captureBeyondViewport: whole});
  writeFileSync(`${folder}/${name}.png`, Buffer.from(data, 'base64'));
}

async function screenshot(name, {width = 1280, height = 1000, scale = 1, dark = false, small = false} = {}) {
  await send('Emulation.setDeviceMetricsOverride', {width, height, deviceScaleFactor: scale, mobile: small});
  await send('Emulation.setEmulatedMedia', {features: [
    {name: 'prefers-color-scheme', value: dark ? 'dark' : 'light'},
    {name: 'prefers-reduced-motion', value: 'reduce'}]});
  await open('count=10000&distribution=circle');
  await settled();
  await pause(500);
  assert.equal(await evaluate('document.body.dataset.mdColorScheme'), dark ? 'slate' : 'default');
  assert.ok(await evaluate('document.documentElement.scrollWidth <= innerWidth'), `${name} scrolls sideways`);
  // As large as the canvas allows.
  assert.ok(await extent('.live-ours') > 0.9 && await extent('.live-peer') > 0.9, `${name} is drawn too small`);
  const beyond = await evaluate(`[...document.querySelectorAll('.live-controls *, table:not([class]) th')]
    .filter((element) => element.getBoundingClientRect().right > ${width}).map((element) => element.textContent)`);
  assert.deepEqual(beyond, [], `${name}: out of sight`);
  await capture(name, small);
}

const pixels = (name) => evaluate(`(() => { const canvas = document.querySelector('${name}');
  const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  for (let k = 3; k < data.length; k += 4) count += data[k] > 0;
  return count; })()`);

// Goes on after a failure, so that one run tells all.
async function section(name, work) {
  try {
    await work();
    console.log(`right: ${name}`);
  } catch (error) {
    console.log(`wrong: ${name}: ${error.stack}`);
    process.exitCode = 1;
  }
}

// The part of the canvas' width that is drawn on.
const extent = (name) => evaluate(`(() => { const canvas = document.querySelector('${name}');
  const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  let least = canvas.width, most = 0;
  for (let k = 3; k < data.length; k += 4) if (data[k] > 0) {
    least = Math.min(least, (k >> 2) % canvas.width);
    most = Math.max(most, (k >> 2) % canvas.width);
  }
  return (most - least) / canvas.width; })()`);

const measured = {};
try {
  const {targetId} = await send('Target.createTarget', {url: 'about:blank'});
  session = (await send('Target.attachToTarget', {targetId, flatten: true})).sessionId;
  for (const domain of ['Page', 'Runtime', 'Log', 'Network']) await send(`${domain}.enable`);
  const still = [{name: 'prefers-reduced-motion', value: 'reduce'}];
  await send('Emulation.setDeviceMetricsOverride', {width: 1280, height: 1000, deviceScaleFactor: 1, mobile: false});
  await send('Emulation.setEmulatedMedia', {features: still});

  await section('loads, draws, and takes nothing from elsewhere', async () => {
    await open('count=20000&distribution=uniform');
    const found = await settled();
    assert.equal(found.wrong, '0');
    assert.equal(found.triangles, found.peerTriangles);
    assert.ok(Number(found.triangles) > 39_900, `${found.triangles} triangles`);
    assert.ok(await pixels('.live-ours') > 100_000 && await pixels('.live-peer') > 100_000, 'nothing was drawn');
    const loaded = [...new Set(requests)].filter((url) => !url.startsWith('data:'));
    assert.deepEqual(loaded.filter((url) => !url.startsWith(address)), [], 'loaded from elsewhere');
    const parts = await Promise.all(loaded.map(async (url) => Buffer.from(await (await fetch(url)).arrayBuffer())));
    measured.page = {
      requests: loaded.length, bytes: parts.reduce((sum, part) => sum + part.length, 0),
      compressed_bytes: parts.reduce((sum, part) => sum + gzipSync(part, {level: 9}).length, 0),
    };
  });

  await section('stands still if motion is not wanted, and moves otherwise', async () => {
    const before = (await state()).place;
    await pause(700);
    assert.equal((await state()).place, before, 'moved in spite of prefers-reduced-motion');
    await send('Emulation.setEmulatedMedia', {features: []});
    await open('count=1000');
    const first = (await state()).place;
    await until('motion', `document.querySelector('#live').dataset.place !== '${first}'`);
    await send('Emulation.setEmulatedMedia', {features: still});
  });

  await section('drags', async () => {
    measured.drag = {};
    for (const count of [10_000, 20_000, 100_000]) {
      await open(`count=${count}`);
      const {place} = await settled();
      measured.drag[count] = await drag(3);
      const found = await settled();
      assert.notEqual(found.place, place, 'was not dragged');
      assert.equal(found.wrong, '0');
      assert.equal(found.triangles, found.peerTriangles);
      // Only the part around the point was drawn anew; now all is.
      const partly = await pixels('.live-ours');
      await choose('view', 'edges');
      await pause(300);
      assert.ok(Math.abs(await pixels('.live-ours') - partly) < 20, 'a part was drawn differently');
    }
  });

  await section('is right where delaunator is not', async () => {
    await open('count=10000&distribution=circle');
    const found = await settled();
    assert.equal(found.triangles, '9998');
    assert.equal(found.wrong, '0');
    assert.ok(Number(found.peerWrong) > 1000, `${found.peerWrong} wrong edges of delaunator`);
    measured.circle = {wrong_edges: Number(found.wrong), wrong_edges_of_delaunator: Number(found.peerWrong)};
    for (const distribution of ['normal', 'clusters', 'kuzmin', 'grid', 'tilted grid', 'spiral']) {
      await open(`count=10000&distribution=${distribution}`);
      assert.equal((await settled()).wrong, '0', distribution);
    }
  });

  await section('draws segments, by the pointer and by keys', async () => {
    await open('count=1000');
    await settled();
    const {left, top, width, height} = await box();
    await choose('tool', 'segment');
    await mouse('mousePressed', left + 0.2 * width, top + 0.5 * height);
    await mouse('mouseMoved', left + 0.7 * width, top + 0.5 * height);
    await mouse('mouseReleased', left + 0.8 * width, top + 0.45 * height);
    let found = await settled();
    assert.equal(found.segments, '1');
    assert.equal(found.wrong, '0');
    await mouse('mousePressed', left + 0.5 * width, top + 0.2 * height);
    await mouse('mouseReleased', left + 0.5 * width, top + 0.8 * height);
    await until('error', `/cross/.test(document.querySelector('.live-message').textContent)`);
    await evaluate(`document.querySelector('#live [name=clear]').click()`);
    await until('segments cleared', `document.querySelector('#live').dataset.segments === '0'`);
    await evaluate(`document.querySelector('.live-ours').focus()`);
    const {selected} = await settled();
    await key('Enter');
    for (let k = 0; k < 4; k++) await key('ArrowRight', 8);
    await key('Enter');
    found = await settled();
    assert.notEqual(found.selected, selected, 'no other point was selected');
    assert.equal(found.segments, '1');
    await evaluate(`document.querySelector('#live [name=clear]').click()`);
    const {place} = await settled();
    await key('ArrowUp');
    await until('move by key', `document.querySelector('#live').dataset.place !== '${place}'`);
    assert.equal((await settled()).wrong, '0');
  });

  await section('draws cells and colours', async () => {
    const edges = await pixels('.live-ours');
    await key('v');
    await settled();
    await pause(200);
    const cells = await pixels('.live-ours');
    assert.ok(cells > 10_000 && cells !== edges, `${cells} pixels of cells`);
    await capture('cells');
    await key('v');
    await pause(500);
    await capture('colours');
    assert.ok(await pixels('.live-colours') > 10_000, 'no colours');
  });

  await section('reads files', async () => {
    const drop = (name, text) => evaluate(`(() => { const files = new DataTransfer();
      files.items.add(new File([${JSON.stringify(text)}], '${name}'));
      document.querySelector('#live').dispatchEvent(new DragEvent('drop', {dataTransfer: files})); })()`);
    await drop('square.csv', 'x,y\n0,0\n4,0\n4,3\n0,3\n');
    await until('triangles of a file', `document.querySelector('#live').dataset.triangles === '2'`);
    // Columns by their names, and decimal commas: five points, one inside of the others.
    await drop('named.csv', 'id;lon;lat\n1;0;0\n2;4;0\n3;4;4\n4;0;4\n5;2,5;1,5\n');
    await until('triangles of columns', `document.querySelector('#live').dataset.triangles === '4'`);
    // Columns that are named as other coordinates, and names with separators, in files of the same five points.
    const {place} = await settled();
    for (const [k, text] of [
      'n,x,y\n1,0,0\n1,4,0\n1,4,4\n1,0,4\n1,2.5,1.5\n', 'lat,e,lon\n0,1,0\n0,1,4\n4,1,4\n4,1,0\n1.5,1,2.5\n',
      'north;east\n0;0\n0;4\n4;4\n4;0\n1,5;2,5\n', '0 0;\n4 0;\n4 4;\n0 4;\n2.5 1.5;\n',
      '"name"\t"x"\t"y"\nRoute 66\t0\t0\n\t4\t0\nA\t4\t4\nB\t0\t4\nC\t2,5\t1,5\n',
      'name,x,y\n"Peak, A",0,0\n"a; ""b""",4,0\n5",4,4\n,0,4\nC,2.5,1.5\n',
      '0,0,a\n4,0,"b;c"\n4,4,\n0,4\n2.5,1.5,d\n', '0\t\t0\n4 0\n\t4 4\n0\t4\t\n2.5\t1.5\n',
    ].entries()) {
      await open('count=1000');
      await drop(`${k}.txt`, text);
      await until(`triangles of ${JSON.stringify(text)}`, `document.querySelector('#live').dataset.triangles === '4'`);
      assert.equal((await settled()).place, place, text);
    }
    // Text may be dropped elsewhere, as into the search field, but a file would take the place of the page.
    assert.deepEqual(await evaluate(`[['x', 'text/plain'], [new File(['x'], 'x')]].map((item) => {
      const dataTransfer = new DataTransfer();
      dataTransfer.items.add(...item);
      return !document.body.dispatchEvent(new DragEvent('drop', {dataTransfer, bubbles: true, cancelable: true}));
    })`), [false, true]);
    const points = [[0, 0], [4, 0], [2, 3]].map((coordinates) => ({
      type: 'Feature', properties: {}, geometry: {type: 'Point', coordinates}}));
    await drop('three.geojson', JSON.stringify({type: 'FeatureCollection', features: points}));
    await until('triangle of GeoJSON', `document.querySelector('#live').dataset.triangles === '1'`);
    // Two polygons with a common side, one with a hole: their sides are segments, and their insides are filled.
    const square = (x0, y0, x1, y1) => [[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]];
    await drop('squares.geojson', JSON.stringify({type: 'MultiPolygon',
      coordinates: [[square(0, 0, 4, 4), square(1, 1, 3, 3)], [square(4, 0, 8, 4)]]}));
    await choose('view', 'edges');
    await until('segments of GeoJSON', `document.querySelector('#live').dataset.segments === '11'`);
    const shown = await settled();
    await pause(300);
    assert.deepEqual([shown.triangles, shown.wrong], ['12', '0']);
    const filled = await pixels('.live-colours'), all = await evaluate(`(() => {
      const {width, height} = document.querySelector('.live-colours'); return width * height; })()`);
    // 28 of the 8 x 4 that are drawn to 92 % of the width.
    assert.ok(Math.abs(filled / all - 0.92 * 0.92 * 28 / 64) < 0.02, `${filled} of ${all} pixels are filled`);
    for (const [name, text, error] of [
      ['bad.txt', '0 0\n1 0\n1 one\n', /line 3/], ['empty.csv', 'x,y\n,1\n', /line 2/], ['other.json', '{"a": 1}', /no GeoJSON/],
      ['huge.csv', '1e308 0\n0 1e308\n0 0\n', /the page draws/],
    ]) {
      await drop(name, text);
      await until(`error of ${name}`, `/^${name}: .*${error.source}/.test(document.querySelector('.live-message').textContent)`);
    }
  });

  await section('is readable in light, in dark and on a small screen', async () => {
    await screenshot('light');
    await screenshot('dark', {dark: true});
    await screenshot('small', {width: 390, height: 844, scale: 2, small: true});
    await screenshot('smallest', {width: 320, height: 568, scale: 2, small: true});
  });
  await section('has no error in the console', () => assert.deepEqual(problems, []));
  writeFileSync(`${folder}/live.json`, `${JSON.stringify(measured, null, 2)}\n`);
  console.log(JSON.stringify(measured));
} finally {
  browser.removeAllListeners('exit');
  const ended = new Promise((done) => browser.on('exit', done));
  process.kill(-browser.pid, 'SIGKILL'); // with those that it has begun, which write to its profile
  await ended;
  rmSync(profile, {recursive: true, force: true, maxRetries: 20});
}
process.exit(process.exitCode ?? 0);

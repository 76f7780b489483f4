// Times one implementation on one set in a process of its own, and prints seconds of the processor, those of the engine's
// own threads included: of the first call, and the median of others.
//   node one.js MODULE POINTS.npy
import {readFileSync} from 'node:fs';
import {pathToFileURL} from 'node:url';

const [module, path] = process.argv.slice(2);
const {default: Delaunator} = await import(pathToFileURL(module));
const bytes = readFileSync(path);
const begin = bytes.byteOffset + 10 + bytes.readUInt16LE(8);
const coords = new Float64Array(bytes.buffer.slice(begin, bytes.byteOffset + bytes.length));

function time(calls) {
  const before = process.cpuUsage();
  for (let i = 0; i < calls; i++) new Delaunator(coords);
  const {user, system} = process.cpuUsage(before);
  return (user + system) / 1e6 / calls;
}

const first = time(1);
// Engines compile what runs often again, in the background.
for (let spent = first, i = 0; spent < 0.5 || i < 3; i++) spent += time(1);
const calls = Math.max(1, Math.ceil(0.01 / time(3)));
const samples = Array.from({length: 11}, () => time(calls)).sort((a, b) => a - b);
console.log(JSON.stringify({first, seconds: samples[5], fastest: samples[0]}));

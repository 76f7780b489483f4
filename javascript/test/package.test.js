// What package.json names, by the rules that bundlers and TypeScript read it by. FLAUNAY_PACKAGE: the package's folder.
import assert from 'node:assert/strict';
import {existsSync, readFileSync} from 'node:fs';
import {join} from 'node:path';
import test from 'node:test';

const folder = process.env.FLAUNAY_PACKAGE;

test('package.json', {skip: !folder}, () => {
  const {exports, files, main, types, sideEffects, unpkg, jsdelivr} = JSON.parse(readFileSync(join(folder, 'package.json')));
  const targets = Object.values(exports).flatMap((target) => {
    if (typeof target === 'string') return target;
    // The first condition that is met counts.
    const conditions = Object.keys(target);
    assert.equal(conditions[0], 'types');
    assert.equal(conditions.at(-1), 'default');
    return Object.values(target);
  });
  for (const path of [...targets, main, types, unpkg, jsdelivr]) {
    assert.match(path, /^\.\//);
    assert.ok(existsSync(join(folder, path)), path);
  }
  const notices = readFileSync(join(folder, unpkg), 'utf8').match(/^\/\*! flaunay \d+\.\d+\.\d+, MIT licence.* (\S+\.md) /);
  assert.ok(files.includes(notices[1]) && existsSync(join(folder, notices[1])));
  // Importing these loads a module; a bundler may drop the others.
  for (const name of ['.', './points']) {
    for (const condition of ['node', 'default']) assert.ok(sideEffects.includes(exports[name][condition]));
  }
});

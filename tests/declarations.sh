#!/usr/bin/env bash
# Tests what scripts/declare.py writes for JavaScript: the structs against the compiler for WebAssembly, if there is one,
# and what library.js takes from it, by Node, if that is there.
#   declarations.sh PYTHON SOURCE WORK [CLANG]
set -euo pipefail

python=$1 source=$2 work=$3 clang=${4-}
mkdir -p "$work"
"$python" "$source/scripts/declare.py" "$source"/src/include/flaunay/{flaunay.h,result_arrays.hpp} \
  "$work"/declarations.{h,js,d.ts}
if [[ -n $clang ]]; then
  "$clang" --target=wasm32 -x c++ -std=c++17 -fsyntax-only -I "$source/src/include" "$work/declarations.h"
fi
if command -v node >/dev/null; then
  mv "$work/declarations.js" "$work/declarations.mjs"
  node --input-type=module -e "
    import * as declared from '$work/declarations.mjs';
    import {readFileSync} from 'node:fs';
    for (const [, name] of readFileSync('$source/javascript/library.js', 'utf8').matchAll(/\bc\.(\w+)/g)) {
      if (!(name in declared)) throw new Error('library.js names ' + name + ', which nothing declares');
    }"
fi

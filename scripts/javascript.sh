#!/usr/bin/env bash
# Builds the package for JavaScript, tests it in Node and in headless Chromium, and packs it as
# build/javascript/flaunay-VERSION.tgz. On Debian 12, as root, it installs Emscripten and what else it needs.
#   scripts/javascript.sh            without flaunay/threads
#   scripts/javascript.sh --threads  with it, as it is published: the library is compiled twice
# FLAUNAY_COMMAND: the native command, whose results must have the same bytes; it is built if not given.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

presets=(javascript)
if [[ ${1-} == --threads ]]; then presets+=(javascript-threads); fi
scripts/install-deps.sh
packages=(chromium emscripten esbuild node-typescript)
command -v node >/dev/null || packages+=(nodejs)
command -v npm >/dev/null || packages+=(npm)
if ! dpkg-query -W -f '' "${packages[@]}" 2>/dev/null; then
  apt-get update -q
  DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${packages[@]}"
fi

# Emscripten's tool for JavaScript, with threads, needs Debian's acorn.
export NODE_PATH=/usr/share/nodejs
for preset in "${presets[@]}"; do
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset"
done

output=build/javascript
package=$output/package
rm -rf "$package" "$output/installed" "$output"/*.tgz javascript/threads
mkdir -p "$package" "$output/installed"
cp javascript/*.{js,md,ts} LICENSE "$package"
cp "$output"/javascript/{*.wasm,declarations.{js,d.ts}} "$package"
version="$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$output/CMakeCache.txt")"
sed "s/\"version\": \"0.0.0\"/\"version\": \"$version\"/" javascript/package.json >"$package/package.json"
if ((${#presets[@]} == 2)); then
  # Both ways to load it have one module.
  threads=$output-threads/javascript
  cmp "$threads"/{browser,node}.wasm
  mkdir "$package/threads"
  cp "$threads"/{browser.{mjs,wasm,worker.js},node.{js,worker.js}} "$package/threads"
  echo '{"type": "commonjs"}' >"$package/threads/package.json"
  cp -r "$package/threads" javascript
else
  rm "$package"/threads{.js,-node.js,.d.ts}
  sed -i '/"\.\/threads"/d' "$package/package.json"
fi
node -e "process.stdout.write(require('fs').readFileSync('$package/points.wasm', 'hex'))" >"$package/points.hex"
esbuild "$package/script.js" --bundle --minify --format=iife --global-name=flaunay --loader:.hex=text --target=es2022 \
  --banner:js="/*! flaunay $version, MIT licence: LICENSE and NOTICES.md of its package */" --log-level=warning --outfile="$package/flaunay.min.js"
rm "$package"/{points.hex,script.js}

(cd "$package" && npm pack --silent --pack-destination .. >/dev/null)

# Tests import the package by its name, from the folder that they are in.
cp "$package"/{*.wasm,declarations.*} javascript
if [[ -z ${FLAUNAY_COMMAND-} ]]; then
  cmake --preset release >/dev/null
  cmake --build --preset release --target flaunay_cli
  FLAUNAY_COMMAND="$PWD/build/release/flaunay"
fi
export FLAUNAY_COMMAND FLAUNAY_PACKAGE="$PWD/$package"
node --test javascript/test
for lib in es2022 es2022,dom; do
  tsc --noEmit --strict --target es2022 --module node16 --moduleResolution node16 --lib "$lib" javascript/test/types.ts
done

# As it is installed in an empty folder, with the program that users are shown; and the programs of the tutorials.
npm install --silent --offline --no-audit --no-fund --prefix "$output/installed" "$output/flaunay-$version.tgz"
sed -n '/^```js$/,/^```$/{/^```$/q;/^```/d;p}' javascript/README.md >"$output/installed/example.mjs"
(cd "$output/installed" && node example.mjs)
PACKAGE="$package" WORK=build/snippets tests/snippets.sh js docs/tutorials/*.md
echo "$output/flaunay-$version.tgz"

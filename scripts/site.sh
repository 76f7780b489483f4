#!/usr/bin/env bash
# Builds the site from docs/ and site/, in build/site/html, and serves it at http://127.0.0.1:8000.
#   scripts/site.sh           builds and serves
#   scripts/site.sh --build   only builds
# Needs doxygen, Python, and for the first page the module that scripts/javascript.sh makes. MkDocs comes from PyPI,
# into a virtual environment in build/site.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

work=build/site
python="$work/venv/bin/python"
if ! cmp -s site/requirements.txt "$work/venv/installed.txt"; then
  "${PYTHON:-python3}" -m venv --clear "$work/venv"
  "$python" -m pip --disable-pip-version-check --quiet --no-input install -r site/requirements.txt
  cp site/requirements.txt "$work/venv/installed.txt"
fi

# The headers' reference, without the pages, which the site has itself.
version="$(sed -n 's/^ *VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt | head -n 1)"
description="$(sed -n 's/^ *DESCRIPTION "\(.*\)"$/\1/p' CMakeLists.txt)"
sed -e "s|@PROJECT_SOURCE_DIR@|$PWD|g; s|@PROJECT_VERSION@|$version|; s|@DOCUMENTATION_FOLDER@|$PWD/$work/cpp|" \
  -e "s|@PROJECT_DESCRIPTION@|$description|" docs/Doxyfile.in >"$work/Doxyfile"
cat >>"$work/Doxyfile" <<END
INPUT                  = $PWD/src/include/flaunay
USE_MDFILE_AS_MAINPAGE =
END
rm -rf "$work/cpp"
mkdir -p "$work/cpp"
doxygen "$work/Doxyfile"

# The WebAssembly module, for the first page.
package=build/javascript/package
rm -rf "$work/module"
if [[ -f $package/flaunay.wasm ]]; then
  mkdir "$work/module"
  cp "$package"/{declarations.js,flaunay.js,flaunay.wasm,index.js,library.js} "$work/module"
else
  echo 'site.sh: the first page has no triangulation, since scripts/javascript.sh has not made its module' >&2
fi

NO_MKDOCS_2_WARNING=1 "$work/venv/bin/mkdocs" --quiet build --strict --clean --config-file site/mkdocs.yml
if [[ ${1-} != --build ]]; then
  "$python" -m http.server --bind 127.0.0.1 --directory "$work/html" 8000
fi

#!/usr/bin/env bash
# figures.sh PYTHON [FLAUNAY]: the pictures in docs/ that are drawn from what its pages print are those in the
# repository, and so are those that the command draws, if there is one.
set -euo pipefail
tests="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
docs="$(dirname "$tests")/docs"
folder="$(mktemp -d)"
drawn="$folder/drawn.svg"
trap 'rm -rf "$folder"' EXIT
"$1" "$docs/figures/data_layout.py" "$docs/data-layout.md" "$drawn"
if ! cmp "$docs/data-layout.svg" "$drawn"; then
  echo 'figures.sh: run docs/figures/data_layout.py docs/data-layout.md docs/data-layout.svg' >&2
  exit 1
fi
if [[ -n ${2-} ]]; then
  "$2" triangulate "$tests/data/africa.geojson" --quiet -o "$drawn"
  if ! cmp "$docs/figures/africa.svg" "$drawn"; then
    echo 'figures.sh: run flaunay triangulate tests/data/africa.geojson -o docs/figures/africa.svg' >&2
    exit 1
  fi
fi

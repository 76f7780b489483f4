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

# drawing NAME OPTION...: docs/figures/ has what the command draws of a file of tests/data.
drawing() {
  local file="$1" figure="figures/${1%.*}.svg"
  shift
  "$flaunay" triangulate "$tests/data/$file" "$@" --quiet -o "$drawn"
  if ! cmp "$docs/$figure" "$drawn"; then
    echo "figures.sh: run flaunay triangulate tests/data/$file $* -o docs/$figure" >&2
    exit 1
  fi
}

flaunay="${2-}"
if [[ -n $flaunay ]]; then
  drawing africa.geojson
  drawing star.poly --crossings split --fill even-odd
  drawing letter.poly --outside holes --min-angle 30 --max-area 0.005
  mkdir "$folder/refined"
  "$1" "$docs/figures/refined.py" "$flaunay" "$folder/refined"
  for picture in "$folder"/refined/*.svg; do
    if ! cmp "$docs/figures/${picture##*/}" "$picture"; then
      echo "figures.sh: run docs/figures/refined.py $flaunay docs/figures" >&2
      exit 1
    fi
  done
fi

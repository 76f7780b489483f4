#!/usr/bin/env bash
# Triangulates a million points, checks the result exactly, and draws a smaller triangulation.
# Needs only Debian 12: installs and builds everything else first. Results: build/demo.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install-deps.sh --build

say() { printf '\n== %s\n' "$*"; }

say 'Building'
cmake --preset command >/dev/null
cmake --build --preset command

flaunay=build/command/flaunay
demo=build/demo
mkdir -p "$demo"

say 'The devices here'
"$flaunay" devices

say 'A million points of the kuzmin distribution: dense in the middle, sparse outside'
"$flaunay" generate kuzmin 1000000 --seed 1 -o "$demo/million.npy"
"$flaunay" triangulate "$demo/million.npy" --triangles "$demo/million-triangles.npy" \
  --neighbors "$demo/million-neighbors.npy" --hull "$demo/million-hull.npy" --stats "$demo/million-stats.json"

say 'Verifying every triangle with exact arithmetic, independently, on the host'
"$flaunay" verify "$demo/million.npy" "$demo/million-triangles.npy" --neighbors "$demo/million-neighbors.npy"

say 'A picture of 2,000 points'
"$flaunay" generate kuzmin 2000 --seed 1 -o "$demo/kuzmin.npy"
"$flaunay" triangulate "$demo/kuzmin.npy" -o "$demo/kuzmin.svg"

say 'Its 16 regions after four levels, each solved on its own, put together again and verified'
"$flaunay" partition "$demo/kuzmin.npy" --levels 4 -o "$demo/regions" --force --picture "$demo/regions.svg"
for region in "$demo"/regions/region-*.node; do
  "$flaunay" triangulate "$region" --mode dwyer --quiet -o "${region%.node}.npy"
done
"$flaunay" assemble "$demo/kuzmin.npy" "$demo/regions" --triangles "$demo/kuzmin-triangles.npy"
"$flaunay" verify "$demo/kuzmin.npy" "$demo/kuzmin-triangles.npy"

pictures=()
for name in kuzmin regions; do
  pictures+=("$PWD/$demo/$name.svg")
  if command -v rsvg-convert >/dev/null; then
    rsvg-convert "$demo/$name.svg" -o "$demo/$name.png"
    pictures+=("$PWD/$demo/$name.png")
  fi
done

say 'Done'
printf 'picture:    %s\n' "${pictures[@]}"
echo "triangles:  $PWD/$demo/million-triangles.npy"
echo "statistics: $PWD/$demo/million-stats.json"

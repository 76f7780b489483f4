#!/usr/bin/env bash
# Builds and runs the tests. Needs only Debian 12: installs everything else first.
#   scripts/test.sh           all but those of benchmarks and those labelled nightly, which scripts/attack.sh runs; those
#                             labelled asan once more under the sanitizers
#   scripts/test.sh --quick   on the host alone, and the command: without MPI, packages, simulators, documents, systems
#                             that fail, and what is about devices
#   scripts/test.sh --kernels FOLDER   what a change of kernels/FOLDER concerns: its suites on the host, and its calls on
#                             the first device, in the release build; for daily work
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# By folder of kernels, the program whose suites test them, and the call of `flaunay devices --test` that launches them.
declare -A concerned=(
  [blocks]='test_blocks sets' [call]='test_blocks sets' [constrained]='test_insertion constrained'
  [flattened]='test_flattened modes' [interpolate]='test_queries interpolate' [locate]='test_queries queries'
  [operations]='test_host sets' [periodic]='test_queries torus' [points]='test_blocks sets' [raster]='test_queries terrain'
  [refinement]='test_refinement refine' [sphere]='test_queries sphere' [updates]='test_updates updates'
  [voronoi]='test_queries voronoi'
)
usage() {
  echo "usage: scripts/test.sh [--quick | --kernels FOLDER], where FOLDER is one of ${!concerned[*]}" >&2
  exit 2
}
quick=false folder=
case "${1-}" in
  '') ;;
  --quick) quick=true ;;
  --kernels)
    folder="${2-}"
    [[ -n $folder && -n ${concerned[$folder]-} ]] || usage
    ;;
  *) usage ;;
esac

# What install-deps.sh has installed must not be missing.
export FLAUNAY_TEST_ALL=1

if [[ -n $folder ]]; then
  read -r suites call <<<"${concerned[$folder]}"
  cmake --preset release
  cmake --build --preset release --target flaunay_cli "$suites"
  export POCL_CACHE_DIR="${POCL_CACHE_DIR-$PWD/build/kernels}" FLAUNAY_CACHE_DIR="${FLAUNAY_CACHE_DIR-}"
  FLAUNAY_TEST_DEVICE=host "build/release/tests/$suites" --gtest_brief=1
  exec build/release/flaunay devices --test --device '#0' --points 300 --only "$call"
fi

jobs="$(nproc)"
build() {
  cmake --preset "$@"
  cmake --build --preset "$1" --parallel "$jobs"
}

scripts/install-deps.sh --build
# What only the tests need is installed while the library is compiled.
scripts/install-deps.sh &
installing=$!
if [[ ! -e build/release/CMakeCache.txt ]]; then
  cmake --preset release -DFLAUNAY_TESTS=OFF -DFLAUNAY_BENCH=OFF
  cmake --build --preset release --target flaunay_core --parallel "$jobs"
fi
wait "$installing"
scripts/format.sh --check

if $quick; then
  build release -DFLAUNAY_BENCH=OFF
else
  build release -DFLAUNAY_BENCH=ON -DFLAUNAY_MPI=ON -DFLAUNAY_GDAL=ON
  # With the tests' objects of the build above: the library is what is to be sanitized.
  build asan -DFLAUNAY_COMMAND=OFF -DFLAUNAY_TEST_OBJECTS="$PWD/build/release" -DCMAKE_EXE_LINKER_FLAGS=-fuse-ld=lld
  # PoCL and its compiler leak memory. Leaks of flaunay are detected in the tests that open no device, which turn the
  # detection on again.
  ASAN_OPTIONS=detect_leaks=0 ctest --preset asan --label-regex asan --no-tests=error -j "$jobs"
fi
# Last, so that its summary is what the script ends with; the sanitized tests have passed when it is reached.
left_out=nightly
if $quick; then left_out='nightly|devices|docs|faults|oclgrind|package'; fi
ctest --preset release --no-tests=error -j "$jobs" --label-exclude "$left_out"

#!/usr/bin/env bash
# Builds and runs all tests. Needs only Debian 12: installs everything else first.
#   scripts/test.sh           everything; the tests labelled asan once more under the sanitizers, and some fuzzing
#                             the readers of files
#   scripts/test.sh --quick   without the sanitizers, and without the tests labelled configurations, which check on other
#                             devices, with other sizes and the like what others check already
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

quick=false
case "${1-}" in
  '') ;;
  --quick) quick=true ;;
  *)
    echo "usage: scripts/test.sh [--quick]" >&2
    exit 2
    ;;
esac

scripts/install-deps.sh
scripts/format.sh --check

# What install-deps.sh has installed must not be missing.
export FLAUNAY_TEST_ALL=1

jobs="$(nproc)"
build() {
  cmake --preset "$@"
  cmake --build --preset "$1"
}

build release -DFLAUNAY_MPI=ON -DFLAUNAY_GDAL=ON
if ! $quick; then
  build asan
  # PoCL and its compiler leak memory. Leaks of flaunay are detected in the tests that open no device, which turn the
  # detection on again.
  ASAN_OPTIONS=detect_leaks=0 ctest --preset asan --label-regex asan --no-tests=error -j "$jobs"
  scripts/fuzz.sh 20s readers
fi
# Last, so that its summary is what the script ends with; the sanitized tests have passed when it is reached.
some=()
if $quick; then some=(--label-exclude configurations); fi
ctest --preset release --no-tests=error -j "$jobs" "${some[@]}"

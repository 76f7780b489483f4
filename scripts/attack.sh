#!/usr/bin/env bash
# Looks for errors in ways that take too long for every run of the tests; scripts/fuzz.sh looks for hours.
#   scripts/attack.sh [ATTACK...]    all, or those named; the times are those of two cores, without building
#     allocations    2 minutes   each allocation of many calls fails, one after the other, in the release build
#     threads        6 minutes   calls at once, chunks and failing allocations under the thread sanitizer
#     segments       5 minutes   random segments under the sanitizers of addresses and undefined behaviour
#     tunings       10 minutes   sets of up to 100,000 points, with sizes of GPUs and in both arithmetics
#     devices       10 minutes   all calls and kernels on every OpenCL runtime for CPUs that pip can install
#     sanitizers     5 minutes   the tests of the command under those of addresses and undefined behaviour
#     benchmarks     4 minutes   the benchmarks and the script for a GPU, on little input
#     nightly        6 minutes   the tests with that label: fuzzers of the library, CGAL's triangulations, all of the
#                                library as a part of another project, installed as a static library
#     readers        2 minutes   random bytes in files of all formats
#     files          3 minutes   files of all formats in chunks, and over ranks of MPI, compared with runs in memory
# Fails if an attack found something, and says what.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build() {
  local preset="$1"
  shift
  # As presets are by themselves: scripts/test.sh sets these.
  cmake --preset "$preset" -DFLAUNAY_COMMAND=ON -DFLAUNAY_TEST_OBJECTS= && cmake --build --preset "$preset" --target "$@"
}

allocations() {
  build release test_allocations && FLAUNAY_EVERY_ALLOCATION=1 build/release/tests/test_allocations --gtest_brief=1
}

# PoCL was not compiled with the sanitizer, which would report its threads. The sanitizer needs addresses that are not
# random beyond some bits.
threads() {
  build tsan test_threads test_chunks test_allocations || return
  local test
  for test in test_threads test_chunks test_allocations; do
    FLAUNAY_DEVICE=host setarch -R "build/tsan/tests/$test" --gtest_brief=1 || return
  done
}

segments() {
  build asan fuzz_constrained || return
  # PoCL and its compiler leak memory.
  ASAN_OPTIONS=detect_leaks=0 build/asan/tests/fuzz_constrained --seconds 300 --seed "$RANDOM"
}

sanitizers() {
  build asan test_cli || return
  ASAN_OPTIONS=detect_leaks=0 ctest --preset asan -R '^Command'
}

benchmarks() {
  cmake --preset release -DFLAUNAY_BENCH=ON && build release all test_bench || return
  ctest --preset release -R '^(Bench|Prediction|Paper)Test|^scripts.gpu'
}

nightly() {
  cmake --preset release -DFLAUNAY_GDAL=ON && build release all nightly && ctest --preset release --label-regex nightly
}

readers() {
  scripts/fuzz.sh 120s readers
}

tunings() {
  build release fuzz_triangulations && build/release/tests/fuzz_triangulations --tunings --seconds 600 --seed "$RANDOM"
}

devices() {
  build release flaunay_cli && scripts/devices.py
}

files() {
  cmake --preset release -DFLAUNAY_MPI=ON && build release flaunay_cli flaunay_mpi_cli || return
  FLAUNAY_DEVICE=host "${PYTHON:-/usr/bin/python3}" tests/chunk_files.py build/release/flaunay --seconds 180 \
    --seed "$RANDOM" \
    --mpi 'mpirun --allow-run-as-root --oversubscribe -x FLAUNAY_THREADS=1 -n 3 build/release/flaunay-mpi'
}

all=(allocations threads segments sanitizers benchmarks nightly readers tunings devices files)
attacks=("$@")
if [[ $# == 0 ]]; then attacks=("${all[@]}"); fi
for attack in "${attacks[@]}"; do
  if [[ " ${all[*]} " != *" $attack "* ]]; then
    echo "usage: scripts/attack.sh [$(IFS='|' && echo "${all[*]}")]..." >&2
    exit 2
  fi
done
export POCL_CACHE_DIR="${POCL_CACHE_DIR-$PWD/build/kernels}" FLAUNAY_CACHE_DIR="${FLAUNAY_CACHE_DIR-}"
scripts/install-deps.sh --all
failed=()
for attack in "${attacks[@]}"; do
  echo "== $attack"
  "$attack" || failed+=("$attack")
done
if ((${#failed[@]} > 0)); then
  echo "found something: ${failed[*]}"
  exit 1
fi

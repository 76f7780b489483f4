#!/usr/bin/env bash
# Runs clang-tidy (.clang-tidy) on files of the library and of the command, on all of them if none is named. Unlike in
# the release build, each file is compiled separately, so this also checks that every file includes what it needs.
#   scripts/tidy.sh [FILE.cpp...]
# Needs clang-tidy, 14 or later. Takes about 5 seconds per file.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

command -v clang-tidy >/dev/null || { echo 'tidy: clang-tidy is missing: apt-get install clang-tidy' >&2; exit 1; }
# Writes the compile commands; nothing is built.
cmake -S . -B build/tidy -G Ninja -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DCMAKE_UNITY_BUILD=OFF -DFLAUNAY_BENCH=OFF \
  -DFLAUNAY_TESTS=OFF >/dev/null
files=("$@")
if ((${#files[@]} == 0)); then
  files=(host/*.cpp src/*/*.cpp)
fi
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "$(nproc)" clang-tidy -p build/tidy --quiet

#!/usr/bin/env bash
set -euo pipefail
cmake -S . -B build -G Ninja ${CMAKE_ARGS-} -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$PREFIX" \
  -DCMAKE_INSTALL_LIBDIR=lib -DFLAUNAY_TESTS=OFF -DFLAUNAY_BENCH=OFF
cmake --build build --parallel "$CPU_COUNT"
cmake --install build

#!/usr/bin/env bash
# The installed command works, and programs in C++ and C are built against the installed library and run.
set -euo pipefail
flaunay generate circle 5000 -o points.npy
flaunay triangulate points.npy --triangles triangles.npy
flaunay verify points.npy triangles.npy
cmake -S tests/consumer -B build -G Ninja -DCMAKE_PREFIX_PATH="$PREFIX" -DFLAUNAY_HAS_C=ON
cmake --build build
build/consumer
build/consumer_c

#!/bin/sh
# Compiles every kernel file as strictly as clang can: compilers of drivers refuse extensions of OpenCL C 1.2 that
# PoCL's, which is clang, takes, such as macros with any number of arguments (NVIDIA).
#
#   tests/strict_kernels.sh CLANG KERNELS_FOLDER
set -eu
clang=$1
cd "$2"
sizes='-DSORT_BITS=4 -DSORT_GROUP=128 -DLOCAL_BYTES=32768 -DATOMIC_READS=1 -DSMALL_REGION=48 -DFETCH_AHEAD=0'
code=0
for file in */*.cl; do
  for more in '' -DFLAUNAY_COUNT; do
    [ "$file" != call/self_test_fixed.cl ] || more="$more -DFIXED_POINT"
    # shellcheck disable=SC2086
    "$clang" -target spir64 -x cl -cl-std=CL1.2 -fsyntax-only -Xclang -finclude-default-header -Wpedantic -Werror -I. \
      $sizes $more "$file" || code=1
  done
done
exit $code

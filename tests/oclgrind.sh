#!/bin/sh
# Runs a test program's Small* suites under oclgrind, the OpenCL simulator, which checks every memory access, every
# API call, and races between work-items. Fails if a test fails or if oclgrind has anything to say.
#
#   tests/oclgrind.sh [--filter FILTER] PROGRAM [TUNING...]
#
# TUNING: small (the default), gpu, gpu:32, cpu; see host/tuning.hpp. FILTER: GoogleTest's, in place of Small*.
#
# oclgrind puts itself before the OpenCL loader (LD_PRELOAD), so no driver is loaded; FLAUNAY_DEVICE makes sure. Kernels
# are built without optimisation: its interpreter lacks an intrinsic that inlined `restrict` makes, and so no access is
# optimised away before it is checked. Its --uninitialized is not used: it reports initialised memory (21.10).
set -eu

filter='Small*'
if [ "$1" = --filter ]; then
  filter=$2
  shift 2
fi
program=$1
shift
[ $# -gt 0 ] || set -- small
command -v oclgrind >/dev/null || { echo "oclgrind is missing: apt-get install oclgrind" >&2; exit 1; }

log=$(mktemp)
trap 'rm -f "$log"' EXIT
for tuning in "$@"; do
  echo "oclgrind, tuning $tuning: $program"
  code=0
  FLAUNAY_DEVICE=oclgrind FLAUNAY_TUNING=$tuning oclgrind --build-options "-O0" --check-api --data-races \
    --max-errors 100 --log "$log" "$program" --gtest_filter="$filter" --gtest_brief=1 || code=$?
  if [ -s "$log" ]; then
    cat "$log" >&2
    echo "oclgrind found errors, tuning $tuning: $program" >&2
    exit 1
  fi
  [ $code -eq 0 ] || { echo "exit code $code, tuning $tuning: $program" >&2; exit $code; }
done

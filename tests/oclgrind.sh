#!/bin/sh
# Runs all kernels and calls (flaunay devices --test) under oclgrind, the OpenCL simulator, which checks every memory
# access, every API call, and races between work-items. Fails if a result differs from the host's or if oclgrind has
# anything to say.
#
#   tests/oclgrind.sh FLAUNAY TUNING [CALL...]       CALL: of devices --only; without, all calls
#
# oclgrind puts itself before the OpenCL loader (LD_PRELOAD), so no driver is loaded. Kernels are built without
# optimisation: its interpreter lacks an intrinsic that inlined `restrict` makes, and so no access is optimised away
# before it is checked. Its --uninitialized is not used: it reports initialised memory (21.10).
set -eu

program=$1 tuning=$2
shift 2
command -v oclgrind >/dev/null || { echo "oclgrind is missing: apt-get install oclgrind" >&2; exit 1; }

log=$(mktemp)
trap 'rm -f "$log"' EXIT
[ $# -gt 0 ] || set -- ''
for call in "$@"; do
  code=0
  FLAUNAY_TUNING=$tuning oclgrind --build-options "-O0" --local-mem-size 49152 --check-api --data-races --max-errors 100 --log "$log" \
    "$program" devices --test --device '#0' --points 40 ${call:+--only "$call"} || code=$?
  if [ -s "$log" ]; then
    cat "$log" >&2
    echo "oclgrind found errors, tuning $tuning $call" >&2
    exit 1
  fi
  [ $code -eq 0 ] || { echo "exit code $code, tuning $tuning $call" >&2; exit $code; }
done

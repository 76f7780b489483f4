#!/usr/bin/env bash
# Tests of flaunay-mpi, each for one run of CTest:
#
#   command.sh results | errors | killed
#
# In the environment: FLAUNAY, FLAUNAY_MPI (the programs), MPIRUN (the launcher with its options), WORK (a folder to
# work in).
set -euo pipefail

fail() {
  echo "command.sh: $*" >&2
  exit 1
}

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
rm -rf "$WORK"
mkdir -p "$WORK"
cd "$WORK"
export FLAUNAY_DEVICE=host
largest_file=unlimited  # in KiB
read -ra mpirun <<<"$MPIRUN"

# on RANKS ARGUMENTS...: flaunay-mpi triangulate on so many ranks.
on() {
  local ranks=$1
  shift
  : >"$WORK.ranks"
  # shellcheck disable=SC2016
  "${mpirun[@]}" -n "$ranks" bash -c 'ulimit -f "$1"; echo $$ >>"$2"; shift 2; exec "$@"' rank "$largest_file" \
    "$WORK.ranks" "$FLAUNAY_MPI" triangulate --quiet "$@"
}

# refused CODE TEXT RANKS ARGUMENTS...: ends with the code and one message that has the text, and leaves what is there.
refused() {
  local code=$1 text=$2 got=0 before
  shift 2
  before="$(ls -A)"
  on "$@" >out 2>err || got=$?
  rm -f out
  mv err "$WORK.err"
  [[ $got == "$code" ]] || fail "exit code $got, expected $code: $(cat "$WORK.err")"
  [[ $(grep -c '^flaunay-mpi: ' "$WORK.err") == 1 ]] || fail "not one message: $(cat "$WORK.err")"
  grep '^flaunay-mpi: ' "$WORK.err" | grep -qF -- "$text" || fail "no '$text' in $(cat "$WORK.err")"
  [[ $(ls -A) == "$before" ]] || fail "it left something behind: $(ls -A)"
  [[ ! -e t.npy || $(cat t.npy) == old ]] || fail 't.npy changed'
}

case "$1" in
  results)
    "$FLAUNAY" generate kuzmin 20000 -o kuzmin.npy
    "$FLAUNAY" generate uniform 5000 -o uniform.bin
    "$FLAUNAY" generate integer-circle 300 -o circle.bin
    python3 "$here/arrays.py" points
    for points in kuzmin.npy uniform.bin circle.bin float32.npy none.npy two.npy; do
      "$FLAUNAY" triangulate "$points" --triangles expected.npy --hull hull.npy --duplicates duplicates.npy \
        --areas areas.npy >log
      for ranks in 1 4; do
        on "$ranks" "$points" --triangles t.npy --neighbors n.npy --hull h.npy --duplicates d.npy --areas a.npy \
          --stats s.json --round-points 500
        python3 "$here/arrays.py" areas || fail "$points on $ranks ranks: other areas"
        cmp hull.npy h.npy || fail "$points on $ranks ranks: another hull"
        cmp duplicates.npy d.npy || fail "$points on $ranks ranks: other duplicates"
        [[ $(stat -c %s expected.npy) == $(stat -c %s t.npy) ]] || fail "$points on $ranks ranks: triangles are missing"
        "$FLAUNAY" verify "$points" t.npy --neighbors n.npy >log || fail "$points on $ranks ranks: $(cat log)"
        python3 -c "import json, sys; sys.exit(len(json.load(open('s.json'))['ranks']) != $ranks)"
      done
    done
    on 3 kuzmin.npy --triangles wide.npy --index 64
    on 3 kuzmin.npy --triangles narrow.npy
    python3 "$here/arrays.py" width
    [[ -z $(find . -name '*.partial') ]] || fail 'temporary files are left'
    ;;

  errors)
    "$FLAUNAY" generate uniform 20000 -o points.npy
    cp points.npy points.xy
    head -c 100000 points.npy >short.npy
    python3 "$here/arrays.py" nan
    echo old >t.npy
    refused 3 'rank 2: point 19999 is not finite' 3 nan.npy --triangles t.npy
    refused 3 'is truncated' 3 short.npy --triangles t.npy
    refused 3 'missing.npy: cannot be opened' 3 missing.npy --triangles t.npy
    refused 2 'ranks read .npy, .bin, .las' 3 points.xy --triangles t.npy
    refused 2 'this output would overwrite the input' 3 points.npy --triangles points.npy
    refused 2 'two outputs have the same path' 3 points.npy --triangles t.npy --neighbors t.npy
    refused 3 'no/t.npy' 3 points.npy --triangles no/t.npy
    refused 2 '--nonsense' 3 points.npy --nonsense
    refused 4 'rank 1: ' 3 points.npy --triangles t.npy --device 'host,no such device'
    # Larger than a file may be: the write fails on some ranks, after the work. The messages of MPI itself go through
    # smaller files.
    "$FLAUNAY" generate uniform 800000 -o points.npy
    largest_file=16384
    refused 3 'cannot be written' 3 points.npy --triangles t.npy --neighbors n.npy
    ;;

  killed)
    "$FLAUNAY" generate uniform 3000000 -o points.npy
    echo old >t.npy
    : >"$WORK.ranks"
    on 3 points.npy --triangles t.npy --neighbors n.npy >log 2>&1 &
    launcher=$!
    for ((tries = 0; tries < 500; ++tries)); do
      (($(wc -l <"$WORK.ranks") < 3)) || break
      sleep 0.02
    done
    last="$(tail -1 "$WORK.ranks")"
    sleep 0.6
    kill -KILL "$last" || fail 'the ranks were too fast'
    got=0
    wait "$launcher" || got=$?
    ((got != 0)) || fail 'the exit code is 0 though a rank was killed'
    [[ $(cat t.npy) == old && ! -e n.npy ]] || fail 'an output has changed'
    [[ -z $(find . -name '*.partial') ]] || fail 'temporary files are left'
    ;;

  *) fail "unknown test $1" ;;
esac

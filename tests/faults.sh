#!/usr/bin/env bash
# faults.sh CASE: runs the command, and the C interface's test, where the system gives them little: a small stack, little
# address space, no folder for compiled kernels. Each run must succeed, or end with one line and a documented exit code.
# FLAUNAY, C_TEST: the programs. WORK: a folder for files.
set -euo pipefail

: "${FLAUNAY:?}" "${C_TEST:?}" "${WORK:?}"
work="$WORK/$1"
rm -rf "$work"
mkdir -p "$work"
failures=0

fail() {
  echo "faults: $*" >&2
  failures=$((failures + 1))
}

points() {
  local file="$work/$2-$1.npy"
  [[ -e $file ]] || "$FLAUNAY" generate "$2" "$1" --seed 1 -o "$file"
  echo "$file"
}

# attempt WHAT COMMAND...: its exit code in $code; that code must be documented, and the message one line.
attempt() {
  local what="$1"
  shift
  code=0
  "$@" >"$work/out" 2>"$work/err" || code=$?
  if ((code > 4)) || ((code == 1)); then
    fail "$what: exit code $code: $(head -c 500 "$work/err")"
  elif ((code != 0)) && [[ $(wc -l <"$work/err") -ne 1 || $(<"$work/err") != 'flaunay: '* ]]; then
    fail "$what: the message is not one line: $(head -c 500 "$work/err")"
  fi
}

succeed() {
  attempt "$@"
  ((code == 0)) || fail "$1: exit code $code: $(<"$work/err")"
}

# refuse WHAT TEXT COMMAND...: exit code 4, and the text in the message.
refuse() {
  local what="$1" text="$2"
  shift 2
  attempt "$what" "$@"
  ((code == 4)) || fail "$what: exit code $code instead of 4: $(<"$work/err")"
  [[ $(<"$work/err") == *"$text"* ]] || fail "$what: no '$text' in the message: $(<"$work/err")"
}

limited() { # limited OPTION KILOBYTES COMMAND...
  (
    ulimit -S "$1" "$2"
    shift 2
    exec "$@"
  )
}

# PoCL is what lacks memory, or a folder for its kernels; what flaunay itself keeps is out of the way, and so are other
# drivers.
on_pocl() {
  export FLAUNAY_DEVICE='#0' FLAUNAY_CACHE_DIR='' OCL_ICD_VENDORS=/etc/OpenCL/vendors/pocl.icd
}

case "$1" in
  stack)
    # Skewed and degenerate points reach the exact predicates, and small and large regions.
    for distribution in uniform rotated-grid kuzmin; do
      input="$(points 20000 "$distribution")"
      for mode in blocks flattened recursive partition dwyer; do
        succeed "$mode of $distribution points on a small stack" \
          limited -s 256 "$FLAUNAY" triangulate "$input" --mode "$mode" --quiet
      done
    done
    input="$(points 2000 uniform)"
    succeed 'recursive-device on a small stack' \
      limited -s 256 "$FLAUNAY" triangulate "$input" --mode recursive-device --quiet
    succeed 'partition on a small stack' \
      limited -s 256 "$FLAUNAY" partition "$input" --levels 3 -o "$work/regions" --quiet
    # Voronoi diagrams and queries.
    limited -s 256 "$C_TEST" || fail 'c_test on a small stack'
    ;;
  memory)
    input="$(points 50000 uniform)"
    for megabytes in 20 50 100 150 200 300; do
      attempt "$megabytes MB of address space on the host" \
        limited -v $((1024 * megabytes)) "$FLAUNAY" triangulate "$input" --quiet
    done
    succeed '400 MB of address space on the host' limited -v 400000 "$FLAUNAY" triangulate "$input" --quiet
    on_pocl
    # The kernels are compiled at the first run, with enough memory; then from too little for a driver to enough.
    export POCL_CACHE_DIR="$work/kernels"
    succeed '3000 MB of address space' limited -v 3000000 "$FLAUNAY" triangulate "$input" --quiet
    for megabytes in 20 50 100 150 200 250 300 350 400 450 500 550 600 650 700 800 1000; do
      attempt "$megabytes MB of address space" \
        limited -v $((1024 * megabytes)) "$FLAUNAY" triangulate "$input" --quiet
    done
    for megabytes in 100 200 300 400 500 600 700; do
      attempt "$megabytes MB of address space, for the list of devices" \
        limited -v $((1024 * megabytes)) "$FLAUNAY" devices
    done
    refuse 'too little to load a driver' 'ulimit -v' limited -v 100000 "$FLAUNAY" triangulate "$input" --quiet
    # If there are several drivers, the loader opens their devices before it says that there are any.
    for megabytes in 230 250 270 290; do
      refuse "$megabytes MB, too little to load all drivers" 'ulimit -v' \
        limited -v $((1024 * megabytes)) env -u OCL_ICD_VENDORS "$FLAUNAY" triangulate "$input" --quiet
    done
    refuse 'too little to compile' 'ulimit -v' limited -v 450000 "$FLAUNAY" triangulate "$input" --quiet
    # To compile needs no more than the least that is not refused.
    export POCL_CACHE_DIR="$work/none"
    attempt '650 MB of address space to compile in' \
      limited -v $((1024 * 650)) timeout 100 "$FLAUNAY" triangulate "$input" --quiet
    succeed 'a mode without a device' limited -v 300000 "$FLAUNAY" triangulate "$input" --mode dwyer --quiet
    ;;
  cache)
    input="$(points 300 uniform)"
    on_pocl
    touch "$work/file"
    refuse 'a file instead of a folder' "$work/file" \
      env POCL_CACHE_DIR="$work/file" "$FLAUNAY" triangulate "$input" --quiet
    refuse 'a folder that cannot be made' POCL_CACHE_DIR \
      env POCL_CACHE_DIR=/proc/flaunay "$FLAUNAY" triangulate "$input" --quiet
    # Kernels that a full disk has left empty are compiled again.
    kernels="$work/kernels"
    succeed 'an empty folder' env POCL_CACHE_DIR="$kernels" "$FLAUNAY" triangulate "$input" --quiet
    for pattern in '*.so' 'program.bc'; do
      find "$kernels" -name "$pattern" -exec truncate -s 0 {} +
      touch -d '2 hours ago' "$kernels/flaunay-ended-well"
      succeed "empty files $pattern" env POCL_CACHE_DIR="$kernels" "$FLAUNAY" triangulate "$input" --quiet
    done
    # Within an hour nobody looks, so PoCL may end the process; the next one looks.
    find "$kernels" -name '*.so' -exec truncate -s 0 {} +
    env POCL_CACHE_DIR="$kernels" "$FLAUNAY" triangulate "$input" --quiet 2>"$work/err" || true
    succeed 'after a process that did not end well' \
      env POCL_CACHE_DIR="$kernels" "$FLAUNAY" triangulate "$input" --quiet
    # A full disk, where one may be made.
    mkdir "$work/disk"
    if unshare --mount true 2>/dev/null; then
      refuse 'a full disk' "$work/disk" unshare --mount bash -c '
        mount -t tmpfs -o size=2m flaunay-test "$1" || exit 9
        POCL_CACHE_DIR="$1" exec "$2" triangulate "$3" --quiet' - "$work/disk" "$FLAUNAY" "$input"
    fi
    ;;
  *)
    echo "usage: faults.sh stack|memory|cache" >&2
    exit 2
    ;;
esac
((failures == 0))

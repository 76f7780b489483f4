#!/usr/bin/env bash
# Looks for bytes that a reader of files mishandles (tests/fuzz/readers.cpp), and for points and segments that are
# triangulated or refined wrongly (tests/fuzz/triangulations.cpp, constrained.cpp, refinement.cpp), by trying random ones
# for some time.
#   scripts/fuzz.sh 8h                         all, side by side; or 30m, or 90s
#   scripts/fuzz.sh 8h readers                 the readers alone
#   scripts/fuzz.sh 8h triangulations [SEED]   the triangulation alone; the seed is random if it is not given
#   scripts/fuzz.sh 8h constrained [SEED]      the triangulation with segments alone
#   scripts/fuzz.sh 8h refinement [SEED]       the refinement of meshes alone
#   scripts/fuzz.sh 8h weighted [SEED]         regular triangulations alone
#   scripts/fuzz.sh 8h periodic [SEED]         triangulations on tori and cylinders alone
#   scripts/fuzz.sh 8h sphere [SEED]           triangulations on the sphere alone
# Fails if it found something. A file that a reader mishandles is then in build/fuzz/failures; what is triangulated
# wrongly is printed. What the readers were tried with is kept in build/fuzz/found, for the next time.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
  echo 'usage: scripts/fuzz.sh NUMBER{s,m,h} [readers | triangulations | constrained | refinement | weighted | periodic | sphere [SEED]]' >&2
  exit 2
}

[[ ${1-} =~ ^([1-9][0-9]*)([smh])$ ]] || usage
case "${BASH_REMATCH[2]}" in
  s) seconds="${BASH_REMATCH[1]}" ;;
  m) seconds="$((BASH_REMATCH[1] * 60))" ;;
  h) seconds="$((BASH_REMATCH[1] * 3600))" ;;
esac
what="${2-all}"
seed="${3-$((RANDOM << 15 | RANDOM))}"

build="$PWD/build/fuzz"

# One format for some seconds.
fuzz_format() {
  local format="$1" seconds="$2"
  local log="$build/logs/$format"
  if "$build/tests/fuzz/fuzz_readers" "--format=$format" -max_total_time="$seconds" -max_len=4096 -timeout=10 \
    -rss_limit_mb=1024 -dict=tests/fuzz/tokens.txt -artifact_prefix="$build/failures/$format-" \
    "$build/found/$format" "tests/fuzz/seeds/$format" >"$log" 2>&1; then
    echo "$format: $(grep -o 'Done .*' "$log")"
  else
    tail -n 40 "$log"
    echo "$format: failed; the file is in $build/failures"
    return 1
  fi
}

# All formats, on so many cores.
fuzz_readers() {
  local workers="$1" formats=(tests/fuzz/seeds/*)
  formats=("${formats[@]##*/}")
  local each="$((seconds * workers / ${#formats[@]}))"
  cmake --preset fuzz && cmake --build --preset fuzz || return
  mkdir -p "$build/failures" "$build/logs" "${formats[@]/#/$build/found/}"
  # The readers read files, which are best in memory.
  local memory=/dev/shm
  [[ -w $memory ]] || memory="${TMPDIR:-/tmp}"
  TMPDIR="$(mktemp -d -p "$memory" flaunay-fuzz-XXXXXX)"
  trap 'rm -rf "$TMPDIR"' EXIT
  export TMPDIR build
  export -f fuzz_format
  local status=0
  printf '%s\0' "${formats[@]}" |
    xargs -0 -P "$workers" -I '{}' bash -c 'fuzz_format "$1" "$2"' fuzz '{}' "$((each > 0 ? each : 1))" || status=1
  return "$status"
}

# Fuzzers of the library, side by side.
fuzz_library() {
  cmake --preset release && cmake --build --preset release --target "${@/#/fuzz_}" || return
  local fuzzer jobs=() status=0
  for fuzzer in "$@"; do
    build/release/tests/fuzz_"$fuzzer" --seconds "$seconds" --seed "$seed" &
    jobs+=("$!")
  done
  for job in "${jobs[@]}"; do wait "$job" || status=1; done
  return "$status"
}

cores="$(nproc)"
case "$what" in
  readers) fuzz_readers "$cores" ;;
  triangulations | constrained | refinement | weighted | periodic | sphere) fuzz_library "$what" ;;
  all)
    # Those of the library take one core or more.
    fuzz_library triangulations constrained refinement weighted periodic sphere &
    library="$!"
    status=0
    fuzz_readers "$((cores > 2 ? cores - 2 : 1))" || status=1
    wait "$library" || status=1
    exit "$status"
    ;;
  *) usage ;;
esac

#!/usr/bin/env bash
# Tests and measures flaunay on a GPU, beside CuPy where it is installed, and writes what came out to
# bench/results/<device>.json. Needs neither root nor a network. See docs/performance.md, "On a GPU".
#
#   scripts/gpu.sh [--quick] [--device D] [--icd DRIVER]... [--modes M,...] [--output DIR] [--prebuilt DIR]
#   scripts/gpu.sh --pack DIR
#
#   --device D      as for flaunay triangulate; by default the first GPU
#   --icd DRIVER    an OpenCL driver (a library, or an .icd file that names one) for the loader to use, for this run alone
#                   and in place of those installed; more than once for several
#   --modes M,...   the modes to measure, in place of those below
#   --output DIR    where the record goes, by default bench/results
#   --quick         small sizes and few tests: does all of it work?
#   --pack DIR      builds, and copies the programs with the libraries they need to DIR, for --prebuilt elsewhere
#   --prebuilt DIR  programs of --pack, or a build folder, in place of building
#
# Exit code: 0, or 1 if a test failed, a result was wrong or a measurement ended with an error.
set -euo pipefail

# What is measured. The record says which; change it here.
modes=hybrid,flattened,dwyer
distributions=uniform,normal,kuzmin,line
peers=cgal
peer_sizes=10000000
mode_sizes=1024,16384,131072,1048576,4194304
verify_size=200000
runs=5
embedding=() batches=()
device_tests=(test_predicates test_vector_operations test_stages test_hybrid_stages test_derived test_embedding test_triangulation
  test_modes test_work test_cgal)

source="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
command_line="scripts/gpu.sh $*"
output="$source/bench/results"
prebuilt='' pack='' device='' quick=false
drivers=()

fail() {
  echo "gpu.sh: $*" >&2
  exit 2
}
say() { printf '\n== %s\n' "$*"; }
json_string() { printf '"%s"' "$(sed 's/\\/\\\\/g; s/"/\\"/g' <<<"$1" | tr '\n\t' '  ' | sed 's/ *$//')"; }

while (($# > 0)); do
  case "$1" in
    --quick) quick=true ;;
    --help)
      sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//;p}' "${BASH_SOURCE[0]}"
      exit 0
      ;;
    --device | --icd | --modes | --output | --prebuilt | --pack)
      (($# > 1)) || fail "$1 needs a value"
      case "$1" in
        --device) device=$2 ;;
        --icd) drivers+=("$2") ;;
        --modes) modes=$2 ;;
        --output) output=$2 ;;
        --prebuilt) prebuilt=$2 ;;
        --pack) pack=$2 ;;
      esac
      shift
      ;;
    *) fail "unknown option $1 (see scripts/gpu.sh --help)" ;;
  esac
  shift
done
if $quick; then
  peer_sizes=20000 mode_sizes=1024,4096 verify_size=5000 runs=1
  device_tests=(test_vector_operations test_embedding test_triangulation)
  embedding=(--quick) batches=(--quick)
fi

work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

# --- The programs -------------------------------------------------------------------------------------------

build() {
  say 'Building'
  if ! { cmake -S "$source" --preset release >/dev/null && cmake --build "$source/build/release"; }; then
    fail 'it does not build; scripts/install-deps.sh says what is missing'
  fi
}

# Libraries that a program needs but for the C library's own, which a machine has in its own version.
libraries_of() {
  ldd "$1" | awk '$3 ~ /^\// {print $3}' | grep -vE '/(libc|libm|libdl|librt|libpthread|ld-linux[^/]*)\.so'
}

pack_programs() {
  mkdir -p "$pack/tests" "$pack/lib"
  cp "$source"/build/release/flaunay "$source"/build/release/flaunay-bench "$pack/"
  cp "$source"/build/release/tests/test_* "$pack/tests/"
  find "$pack/tests" -type f ! -perm -u+x -delete  # what CMake has put beside them
  find "$pack/tests" -type f -name '*.cmake' -delete
  strip "$pack"/flaunay "$pack"/flaunay-bench "$pack"/tests/test_*
  for program in "$pack"/flaunay "$pack"/flaunay-bench "$pack"/tests/test_*; do libraries_of "$program"; done |
    sort -u | while read -r library; do cp -L "$library" "$pack/lib/"; done
  echo "gpu.sh: $(du -sh "$pack" | cut -f 1) in $pack"
}

if [[ -n $pack ]]; then
  build
  pack_programs
  exit 0
fi
if [[ -z $prebuilt ]]; then
  build
  prebuilt="$source/build/release"
fi
[[ -d $prebuilt ]] || fail "there is no folder $prebuilt"
programs="$(cd "$prebuilt" && pwd)"
[[ -x $programs/flaunay && -x $programs/flaunay-bench ]] || fail "no flaunay and flaunay-bench in $programs"

# Libraries that this machine lacks, or has too old, are taken from the pack; the others are its own, for the driver's
# sake. One may bring the need for another.
libraries="$work/lib"
mkdir "$libraries"
add_missing_libraries() {
  local library missing added=true
  while $added; do
    added=false
    missing="$(for program in "$programs"/flaunay "$programs"/flaunay-bench "$programs"/tests/test_*; do
      LD_LIBRARY_PATH="$libraries" ldd "$program" 2>&1 || true
    done | sed -nE 's/^[[:space:]]*([^ ]+) => not found$/\1/p; s/^.*: ([^ ]*\/)?([^ /]+): version .* not found.*$/\2/p' | sort -u)"
    for library in $missing; do
      if [[ -e $programs/lib/$library && ! -e $libraries/$library ]]; then
        ln -s "$programs/lib/$library" "$libraries/$library"
        added=true
      fi
    done
  done
  [[ -z $missing ]] || fail "libraries are missing, and not in $programs/lib: ${missing//$'\n'/ }"
}
[[ ! -d $programs/lib ]] || add_missing_libraries
own_library_path="$libraries${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
run() { LD_LIBRARY_PATH="$own_library_path" "$@"; }

# --- The device ---------------------------------------------------------------------------------------------

if ((${#drivers[@]} > 0)); then
  mkdir "$work/vendors"
  for k in "${!drivers[@]}"; do
    [[ ${drivers[k]} != */* || -e ${drivers[k]} ]] || fail "there is no driver ${drivers[k]}"
    case "${drivers[k]}" in
      *.icd) cp "${drivers[k]}" "$work/vendors/$k.icd" ;;
      *) echo "${drivers[k]}" >"$work/vendors/$k.icd" ;;
    esac
  done
  export OCL_ICD_VENDORS="$work/vendors"
fi
[[ -z $device ]] || export FLAUNAY_DEVICE="$device"

say 'Devices'
run "$programs/flaunay" devices || fail 'no usable device; --icd names a driver'

failures=()
cupy_verdicts=''

# --- Tests --------------------------------------------------------------------------------------------------

export FLAUNAY_TEST_DATA="$source/tests/data"
export FLAUNAY_EXECUTABLE="$programs/flaunay"
export FLAUNAY_BENCH="$programs/flaunay-bench"
say 'Tests'
filter='*'
tests=("${device_tests[@]}")
if $quick; then
  filter='Small*'
else
  # And all others that are there: they need no device, or find theirs through the programs.
  for program in "$programs"/tests/test_*; do
    name="$(basename "$program")"
    [[ -x $program && -f $program && " ${tests[*]} " != *" $name "* ]] && tests+=("$name")
  done
fi
test_records=()
for name in "${tests[@]}"; do
  log="$work/$name.log"
  begin=$SECONDS code=0
  if [[ -x $programs/tests/$name ]]; then
    run timeout 1800 "$programs/tests/$name" --gtest_brief=1 --gtest_filter="$filter" >"$log" 2>&1 || code=$?
  else
    echo 'not built' >"$log"
    code=127
  fi
  passed="$(sed -nE 's/^\[  PASSED  \] ([0-9]+) test.*/\1/p' "$log" | tail -n 1)"
  failed="$(sed -nE 's/^\[  FAILED  \] ([0-9]+) tests?, listed below:/\1/p' "$log" | tail -n 1)"
  # Without a summary the program has ended early.
  [[ -n $passed || -n $failed ]] || ((code != 0)) || code=1
  printf '%-24s %5s passed %5s failed   exit code %s   %s s\n' "$name" "${passed:-0}" "${failed:-0}" "$code" $((SECONDS - begin))
  test_records+=("{\"program\": \"$name\", \"passed\": ${passed:-0}, \"failed\": ${failed:-0}, \"exit_code\": $code}")
  if ((code != 0)); then
    failures+=("$name")
    tail -n 40 "$log" >&2
  fi
done

# --- Results, checked ---------------------------------------------------------------------------------------

say "Results of $verify_size points, verified"
verify_records=()
for distribution in ${distributions//,/ }; do
  points="$work/verify-$distribution.npy"
  run "$programs/flaunay" generate "$distribution" "$verify_size" --seed 1 -o "$points"
  for mode in ${modes//,/ }; do
    verdict=true
    run "$programs/flaunay" triangulate "$points" --mode "$mode" --quiet --triangles "$work/t.npy" \
      --neighbors "$work/n.npy" &&
      run "$programs/flaunay" verify "$points" "$work/t.npy" --neighbors "$work/n.npy" >"$work/verify.log" || verdict=false
    echo "$distribution, $mode: $($verdict && cat "$work/verify.log" || echo WRONG)"
    verify_records+=("{\"distribution\": \"$distribution\", \"mode\": \"$mode\", \"n\": $verify_size, \"valid\": $verdict}")
    $verdict || failures+=("verify $distribution $mode")
  done
done

# --- Times --------------------------------------------------------------------------------------------------

# bench NAME ARGUMENTS...: the record is $work/NAME.json, or says that there is none.
bench() {
  local name=$1
  shift
  local code=0
  run "$programs/flaunay-bench" "$@" --runs "$runs" --json "$work/$name.json" || code=$?
  ((code == 0)) || failures+=("flaunay-bench $name")
  [[ -s $work/$name.json ]] || echo "{\"error\": \"exit code $code\"}" >"$work/$name.json"
}
chosen=(--distributions "$distributions" --modes "$modes")
say "Times beside others, $peer_sizes points"
bench peers peers --sizes "$peer_sizes" --peers "$peers" "${chosen[@]}"
say 'Times by number of points'
bench modes modes --sizes "$mode_sizes" --count-up-to 0 "${chosen[@]}"
say 'From device memory to device memory, and queries'
bench embedding embedding ${embedding[@]+"${embedding[@]}"}
say 'Thousands of sets in one call'
bench batches batches ${batches[@]+"${batches[@]}"}

say "CuPy's Delaunay triangulation (gDel2D)"
cupy="$work/cupy.json"
if ! reason="$(python3 -c 'import cupy, cupyx.scipy.spatial; cupy.cuda.Device().synchronize()' 2>&1)"; then
  reason="$(tail -n 1 <<<"$reason")"
  echo "not measured: $reason"
  echo "{\"measured\": false, \"reason\": $(json_string "$reason")}" >"$cupy"
else
  inputs=()
  for distribution in ${distributions//,/ }; do
    for n in ${peer_sizes//,/ }; do
      points="$work/$distribution-$n.npy"
      run "$programs/flaunay" generate "$distribution" "$n" --seed 1 -o "$points"  # the seed of flaunay-bench
      inputs+=("$points")
    done
    inputs+=("$work/verify-$distribution.npy")
  done
  if python3 "$source/bench/cupy_delaunay.py" "${inputs[@]}" --runs "$runs" --json "$cupy" --triangles "$work/cupy"; then
    # Its triangles are checked as ours are, which is for information and no failure of ours.
    for distribution in ${distributions//,/ }; do
      triangles="$work/cupy/verify-$distribution.npy"
      [[ -s $triangles ]] || continue
      verdict="$(run "$programs/flaunay" verify "$work/verify-$distribution.npy" "$triangles" 2>&1 || true)"
      verdict="$(head -n 1 <<<"${verdict//"$work/"/}")"
      echo "CuPy, $distribution, $verify_size points: $verdict"
      cupy_verdicts+="${cupy_verdicts:+, }{\"distribution\": \"$distribution\", \"n\": $verify_size, \"verify\": $(json_string "$verdict")}"
    done
  else
    failures+=(CuPy)
    [[ -s $cupy ]] || echo '{"measured": false, "reason": "bench/cupy_delaunay.py failed"}' >"$cupy"
  fi
fi

# --- The record ---------------------------------------------------------------------------------------------

# A string of the bench's own record, quoted as it is there.
of_bench() { sed -nE "s/^  \"$1\": (\".*\"),?\$/\1/p" "$work/peers.json" "$work/modes.json" | head -n 1; }
joined() {
  local IFS=,
  echo "[$*]"
}
device_name="$(of_bench device)"
file_name="$(tr '[:upper:]' '[:lower:]' <<<"${device_name//\"/}" | sed -E 's/[^a-z0-9]+/-/g; s/^-|-$//g')"
failure_strings=()
for failure in ${failures[@]+"${failures[@]}"}; do failure_strings+=("$(json_string "$failure")"); done
mkdir -p "$output"
record="$output/${file_name:-unknown-device}.json"
{
  echo '{'
  for key in device driver platform host commit date; do echo "\"$key\": $(of_bench $key | grep . || echo null),"; done
  echo "\"command\": $(json_string "$command_line"),"
  echo "\"tuning\": $(json_string "${FLAUNAY_TUNING-}"),"
  echo "\"quick\": $quick,"
  echo "\"failures\": $(joined ${failure_strings[@]+"${failure_strings[@]}"}),"
  echo "\"tests\": $(joined "${test_records[@]}"),"
  echo "\"verified\": $(joined "${verify_records[@]}"),"
  echo '"peers":' && cat "$work/peers.json"
  for name in modes embedding batches; do echo ", \"$name\":" && cat "$work/$name.json"; done
  echo ', "cupy":' && cat "$cupy"
  echo ", \"cupy_verified\": [$cupy_verdicts]"
  echo '}'
} >"$work/record.json"
# Python makes it even, and sees that it is JSON; it is not needed.
if command -v python3 >/dev/null; then
  python3 -c 'import json, sys; print(json.dumps(json.load(open(sys.argv[1])), indent=2))' "$work/record.json" >"$record"
else
  cp "$work/record.json" "$record"
fi

say 'Done'
echo "record: $record"
if ((${#failures[@]} > 0)); then
  printf 'FAILED: %s\n' "${failures[@]}"
  exit 1
fi

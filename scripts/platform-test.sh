#!/usr/bin/env bash
# Builds flaunay for another platform and tests it there, in an emulator, against this machine's build.
#
#   scripts/platform-test.sh PLATFORM     windows (in Wine), aarch64 (in QEMU), wasm (in Node), musl or i686 (these run
#                                         here): presets of CMakePresets.json
#
# Runs the tests that need no OpenCL, those of files and streams, and a program that uses the installed library; none of
# these for wasm, whose package has tests of its own. Compares the bytes of all results with this machine's: of the
# library (tests/devices/outputs.cpp) and of the command (scripts/fingerprint.py). Takes up to half an hour. What came of
# it is kept in bench/results/platforms.json.
set -euo pipefail
cd "$(dirname "$0")/.."

platform=${1:?usage: scripts/platform-test.sh PLATFORM}
toolchain=$platform
zig=()
build=$PWD/build/$platform
native=$PWD/build/release
case $platform in
  windows)
    packages=(g++-mingw-w64-x86-64-posix wine wine64 googletest)
    triplet=x86_64-w64-mingw32 suffix=-posix emulator=(wine) exe=.exe consumer_flags=-static
    export WINEPREFIX=$PWD/build/wine WINEDEBUG=-all LC_ALL=C.UTF-8
    ;;
  aarch64)
    packages=(g++-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user googletest)
    triplet=aarch64-linux-gnu suffix='' emulator=(qemu-aarch64 -L /usr/aarch64-linux-gnu) exe='' consumer_flags=''
    ;;
  wasm)
    packages=(emscripten libfast-float-dev)
    # Emscripten of Debian 12 would load files by fetch where Node has that.
    triplet='' emulator=(node --no-experimental-fetch) exe=.js
    export NODE_PATH=/usr/share/nodejs
    ;;
  musl | i686)
    packages=(musl libc6-i386 python3-venv)
    triplet='' emulator=() exe='' consumer_flags=-dynamic
    target=x86_64-linux-musl
    if [[ $platform == i686 ]]; then target=x86-linux-gnu.2.28; fi
    toolchain=zig
    zig=("-DFLAUNAY_ZIG=$(scripts/wheel.sh --zig)" "-DFLAUNAY_ZIG_TARGET=$target")
    ;;
  *)
    echo "platform-test: unknown platform '$platform'; expected windows, aarch64, wasm, musl or i686" >&2
    exit 2
    ;;
esac
for package in "${packages[@]}"; do
  dpkg-query -W "$package" > /dev/null 2>&1 || missing+=("$package")
done
if [[ -n ${missing[*]:-} ]]; then
  echo "platform-test: apt-get install --no-install-recommends ${missing[*]}" >&2
  exit 1
fi
mkdir -p "$build"
work=
clean_up() {
  if [[ -n $work ]]; then rm -rf "$work"; fi
  if [[ $platform == windows ]]; then wineserver -k; fi
}
trap clean_up EXIT
if [[ $platform == windows ]]; then
  # Its services start now and stay, since they would keep the pipes of the first program open.
  wineserver -p
  wineboot < /dev/null > /dev/null 2>&1
fi
# Without a device, on both sides.
export FLAUNAY_DEVICE=host FLAUNAY_CACHE_DIR=

# GMP, with which tests compare, from Debian's sources.
gmp=$PWD/build/gmp-$platform
if [[ -n $triplet && ! -e $gmp/lib/libgmpxx.a ]]; then
  work=$(mktemp -d)
  mkdir -p "$work/sources" "$work/lists/partial"
  for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
    [[ ! -e $list ]] || sed -n 's/^deb /deb-src /p' "$list" > "$work/sources/$(basename "$list" .list).list"
  done
  for list in /etc/apt/sources.list.d/*.sources; do
    [[ ! -e $list ]] || sed 's/^Types:.*/Types: deb-src/' "$list" > "$work/sources/$(basename "$list")"
  done
  apt_options=(-q -o Dir::Etc::SourceList=/dev/null -o "Dir::Etc::SourceParts=$work/sources"
    -o "Dir::State::lists=$work/lists" -o "Dir::Cache::archives=$work" -o APT::Sandbox::User=)
  (
    cd "$work"
    apt-get update "${apt_options[@]}" > log
    apt-get source --download-only gmp "${apt_options[@]}" >> log
    mkdir -p source/doc objects
    tar --extract --strip-components 1 --directory source --file gmp_*.orig.tar.*
    # Debian leaves the documentation out.
    printf 'all install:\n' > source/doc/Makefile.in
    cd objects
    ../source/configure --host="$triplet" --enable-cxx --disable-shared --prefix="$gmp" \
      CC="$triplet-gcc$suffix" CXX="$triplet-g++$suffix" CC_FOR_BUILD=gcc > log
    make -j"$(nproc)" > log
    make install > log
  )
fi

cmake --preset release
cmake --build --preset release --target flaunay_cli device_outputs
cmake --preset "$platform" "${zig[@]}" ${triplet:+-DFLAUNAY_GMP="$gmp"}
cmake --build --preset "$platform"
begin=$SECONDS

tests=0
if [[ -n $triplet ]]; then
  # As those who have only this platform have it: without the compiler's libraries.
  ctest --test-dir "$build" --output-on-failure | tee "$build/ctest.log"
  tests=$(sed -nE 's/^.*tests passed.* out of ([0-9]+)$/\1/p' "$build/ctest.log")
fi
if [[ $platform != wasm ]]; then
  rm -rf "$build/installed"
  cmake --install "$build" --prefix "$build/installed" > /dev/null
  cmake -S tests/consumer -B "$build/consumer" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_TOOLCHAIN_FILE="$PWD/cmake/toolchains/$toolchain.cmake" "${zig[@]}" \
    -DCMAKE_PREFIX_PATH="$build/installed" -DCMAKE_FIND_ROOT_PATH_MODE_PACKAGE=BOTH \
    -DCMAKE_EXE_LINKER_FLAGS="$consumer_flags" -DFLAUNAY_HAS_C=ON > /dev/null
  cmake --build "$build/consumer"
  [[ $platform != windows ]] || cp "$build"/installed/bin/*.dll "$build/consumer/"
  for program in consumer consumer_c; do
    "${emulator[@]}" "$build/consumer/$program$exe"
  done

  python3 tests/platforms/command.py --emulator "${emulator[*]}" "$build/installed/bin/flaunay$exe"
fi

"$native/tests/device_outputs" 20000 > "$build/outputs-here.txt"
"${emulator[@]}" "$build/tests/platforms/device_outputs$exe" 20000 | tr -d '\r' > "$build/outputs.txt"
cmp "$build/outputs-here.txt" "$build/outputs.txt"

scripts/fingerprint.py --quick --emulator none --build "$native" -o "$build/fingerprint-here.json"
scripts/fingerprint.py --quick --emulator "${emulator[*]:-none}" --build "$build" -o "$build/fingerprint.json"
scripts/fingerprint.py --compare "$build/fingerprint-here.json" "$build/fingerprint.json"

python3 - "$platform" "$tests" "$((SECONDS - begin))" "$build" << 'END'
import datetime, hashlib, json, pathlib, subprocess, sys

platform, tests, seconds, build = sys.argv[1:]
record = pathlib.Path("bench/results/platforms.json")
records = json.loads(record.read_text()) if record.exists() else {}
outputs = (pathlib.Path(build) / "outputs.txt").read_bytes()
# Records of several commits agree if the results do; texts of help change with every option.
results = json.loads((pathlib.Path(build) / "fingerprint.json").read_text())
results = {name: value for name, value in results.items() if not name.startswith(("cli/help/", "cli/no-command/"))}


def output_of(*command):
    return subprocess.check_output(command, text=True).strip()


changed = output_of("git", "status", "--porcelain", "--untracked-files=no", "--", ".", f":!{record}")
records[platform] = {
    "commit": output_of("git", "rev-parse", "--short", "HEAD") + ("-dirty" if changed else ""),
    "date": datetime.date.today().isoformat(),
    "test_programs_passed": int(tests),
    "results_of_the_library": outputs.count(b"\n"),
    "results_of_the_command": len(results),
    "sha256_of_the_library": hashlib.sha256(outputs).hexdigest()[:16],
    "sha256_of_the_command": hashlib.sha256(json.dumps(results, sort_keys=True).encode()).hexdigest()[:16],
    "seconds": int(seconds),
}
record.write_text(json.dumps(records, indent=1, sort_keys=True) + "\n")
END
echo "platform-test: $platform passed"

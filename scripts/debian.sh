#!/usr/bin/env bash
# Builds Debian's source package from HEAD, with packaging/debian as its debian, and the binary packages for this system.
#   scripts/debian.sh FOLDER    everything is there; needs what scripts/install-deps.sh --packages installs
set -euo pipefail
folder="$(realpath -m "${1:?a folder}")"
cd "$(dirname "${BASH_SOURCE[0]}")/.."

version="$(sed -n 's/^  VERSION \([0-9.]*\)$/\1/p' CMakeLists.txt)"
rm -rf "$folder"
mkdir -p "$folder"
git archive --prefix="flaunay-$version/" HEAD | gzip --no-name --best >"$folder/flaunay_$version.orig.tar.gz"
tar --extract --directory="$folder" --file="$folder/flaunay_$version.orig.tar.gz"
cd "$folder/flaunay-$version"
cp -r packaging/debian debian
dpkg-buildpackage --unsigned-source --unsigned-changes

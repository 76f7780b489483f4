#!/usr/bin/env bash
# Makes all files of a release that one machine can make, in build/release-files: Debian's packages, the source
# distribution, the wheels, the npm tarball and the site, with a bill of materials and SHA256SUMS. The same commit gives
# the same bytes. It needs to be root where something is missing. What to do before and after: docs/packages.md.
#   scripts/release.sh
# The wheel for macOS cannot be tested here: .github/workflows/platforms.yml is there for that. The recipes for conda,
# Conan and vcpkg, in packaging, build the source.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install-deps.sh --packages
if [[ -n $(git status --porcelain) ]]; then
  echo "release: the source is not that of the last commit" >&2
  exit 1
fi
version="$(sed -n 's/^  VERSION \([0-9.]*\)$/\1/p' CMakeLists.txt)"
commit="$(git rev-parse HEAD)"
SOURCE_DATE_EPOCH="$(git log -1 --format=%ct)"
export SOURCE_DATE_EPOCH
files="$PWD/build/release-files"
rm -rf "$files"
mkdir -p "$files"

# Without the files of dpkg that name the time and the machine, and without debugging symbols.
DEB_BUILD_OPTIONS=noautodbgsym scripts/debian.sh build/debian
cp build/debian/flaunay_"$version"*.{orig.tar.gz,debian.tar.xz,dsc} build/debian/*.deb "$files"

rm -rf build/wheel-*-* build/wheels
scripts/wheel.sh --sdist
scripts/wheel.sh
cp build/wheels/* "$files"

scripts/javascript.sh --threads
cp build/javascript/flaunay-"$version".tgz "$files"

# With the module of the package above on its first page.
scripts/site.sh --build
tar --create --sort=name --mtime="@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner --directory=build/site/html \
  --transform="s|^\.|flaunay-$version-site|" . | gzip --no-name --best >"$files/flaunay-$version-site.tar.gz"

cd "$files"
python=../wheel-tools/bin/python
ziglang="$("$python" -c 'import os, ziglang; print(os.path.dirname(ziglang.__file__))')"
"$python" ../../scripts/sbom.py "$version" "$commit" "$ziglang" ./* >../bill-of-materials.json
mv ../bill-of-materials.json "flaunay-$version.cdx.json"
sha256sum -- * >SHA256SUMS
cat SHA256SUMS

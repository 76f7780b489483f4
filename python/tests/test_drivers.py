"""OpenCL is found where its loader, its drivers or both are missing, but pip has installed a driver."""

import os
import pathlib
import re
import shutil
import subprocess
import sys

import pytest

LOADER = "libOpenCL.so.1"
PROGRAM = """
import flaunay, numpy
points = numpy.random.default_rng(1).random((20000, 2))
names = {device["platform"] for device in flaunay.devices()}
assert names == {"Portable Computing Language"}, names
mesh = flaunay.triangulate(points, device="portable")
assert (mesh.triangles == flaunay.triangulate(points, device="host").triangles).all()
assert mesh.statistics["device"] != "host"
"""


def find_library(name):
    """The path of a library of the system, with links followed; the test is skipped if there is none."""
    found = subprocess.run(["/sbin/ldconfig", "-p"], capture_output=True, text=True, check=True)
    match = re.search(rf"^\s*{re.escape(name)}[.\d]* .*=> (/\S+)$", found.stdout, re.MULTILINE)
    if match is None:
        pytest.skip(f"there is no {name}")
    return os.path.realpath(match[1])


@pytest.fixture
def site(tmp_path):
    """A folder like the one into which pip installs PoCL, with the system's driver in it."""
    driver = find_library("libpocl.so")
    tmp_path /= "with [brackets]"
    (tmp_path / "pocl_binary_distribution").mkdir(parents=True)
    (tmp_path / "pocl_binary_distribution" / "__init__.py").touch()
    (tmp_path / "pyopencl" / ".libs").mkdir(parents=True)
    (tmp_path / "pyopencl" / ".libs" / "pocl.icd").write_text(driver + "\n")
    (tmp_path / "empty").mkdir()
    return tmp_path


def environment(**changes):
    without = {name: value for name, value in os.environ.items() if name != "OCL_ICD_VENDORS"}
    return {**without, **changes}


def run(command, **changes):
    return subprocess.run(
        command,
        env=environment(**changes),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=120,
    )


def without_loader(program, **changes):
    """Runs a program where the loader's file is empty."""
    if os.getuid() != 0 or shutil.which("unshare") is None:
        pytest.skip("only root can hide the loader")
    hide = f'mount --bind /dev/null {find_library(LOADER)} && exec "$@"'
    if run(["unshare", "-m", "sh", "-c", hide, "sh", "true"]).returncode != 0:
        pytest.skip("this system does not let the loader be hidden")
    return run(["unshare", "-m", "sh", "-c", hide, "sh", sys.executable, "-c", program], **changes)


def test_a_driver_that_pip_installed(site):
    done = run(
        [sys.executable, "-c", PROGRAM],
        PYTHONPATH=path_with(site),
        OPENCL_VENDOR_PATH=str(site / "empty"),
    )
    assert done.returncode == 0, done.stderr


def test_it_is_not_used_beside_the_systems(site):
    # It would have no device.
    (site / "pyopencl" / ".libs" / "pocl.icd").write_text(find_library("libm.so") + "\n")
    done = run([sys.executable, "-c", PROGRAM], PYTHONPATH=path_with(site))
    assert done.returncode == 0, done.stderr


def test_the_environment_comes_first(site):
    done = run(
        [sys.executable, "-c", "import flaunay; flaunay.devices()"],
        PYTHONPATH=path_with(site),
        OCL_ICD_VENDORS=str(site / "empty"),
    )
    assert "no OpenCL platform" in done.stderr


def test_drivers_without_a_loader():
    done = without_loader(PROGRAM)
    assert done.returncode == 0, done.stderr


def test_nothing_but_what_pip_installed(site):
    done = without_loader(
        PROGRAM, PYTHONPATH=path_with(site), OPENCL_VENDOR_PATH=str(site / "empty")
    )
    assert done.returncode == 0, done.stderr


def test_neither_loader_nor_drivers(site):
    done = without_loader(
        "import flaunay; flaunay.devices()", OPENCL_VENDOR_PATH=str(site / "empty")
    )
    assert "no OpenCL platform" in done.stderr


def test_a_driver_that_is_none(site):
    (site / "pyopencl" / ".libs" / "pocl.icd").write_text(str(pathlib.Path(__file__)) + "\n")
    done = run(
        [sys.executable, "-c", "import flaunay; flaunay.devices()"],
        PYTHONPATH=path_with(site),
        OPENCL_VENDOR_PATH=str(site / "empty"),
    )
    assert "no OpenCL platform" in done.stderr


def path_with(site):
    return os.pathsep.join(filter(None, [str(site), os.environ.get("PYTHONPATH")]))

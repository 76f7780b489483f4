"""OpenCL drivers that pip installed, beside those of the system."""

from __future__ import annotations

import glob
import importlib.util
import os
from typing import Optional

from flaunay._library import check, library

# The package that flaunay[pocl] brings, the platform that its driver has, and where it says what its driver is.
_PACKAGE = "pocl_binary_distribution"
_PLATFORM = "Portable Computing Language"
_FILES = os.path.join("pyopencl", ".libs", "*.icd")

_are_added = False


def _site_of(package: str) -> Optional[str]:
    """The folder that a package is installed in; None if it is not."""
    spec = importlib.util.find_spec(package)
    return (
        None
        if spec is None or spec.origin is None
        else os.path.dirname(os.path.dirname(spec.origin))
    )


def add_drivers() -> None:
    """Makes the library find PoCL of PyPI, unless the environment says what drivers there are.

    If the system has PoCL, too, that one is used.
    """
    global _are_added
    if _are_added:
        return
    _are_added = True
    site = None if "OCL_ICD_VENDORS" in os.environ else _site_of(_PACKAGE)
    if site is None:
        return
    for file in sorted(glob.glob(os.path.join(glob.escape(site), _FILES))):
        with open(file, encoding="utf-8") as lines:
            driver = os.path.join(os.path.dirname(file), lines.readline().strip())
        if os.path.exists(driver):
            check(library.add_driver(_PLATFORM.encode(), os.fsencode(driver)))

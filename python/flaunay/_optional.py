"""Packages that only some functions need, imported when those are called."""

from __future__ import annotations

import importlib
from typing import Any


def optional(module: str, purpose: str) -> Any:
    """The module; ImportError that names its package and who needs it, if it cannot be imported."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.split(".")[0]
        raise ImportError(
            f"{purpose} needs the package {package}, which cannot be imported ({error}); "
            f"install it with: pip install {package}",
            name=package,
        ) from error

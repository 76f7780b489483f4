"""Modules of the package import each other in layers, without circles."""

import ast
import graphlib
import pathlib

import pytest

import flaunay

FOLDER = pathlib.Path(flaunay.__file__).parent
NAMES = {file.stem for file in FOLDER.glob("*.py")}


def imports_of(text):
    """What a module imports of the package anywhere, also for annotations or inside of functions."""
    found = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            found.update(part for alias in node.names for part in alias.name.split("."))
        elif isinstance(node, ast.ImportFrom):
            found.update((node.module or "").split("."))
            found.update(alias.name for alias in node.names)
    return found & NAMES


IMPORTS = {name: imports_of((FOLDER / f"{name}.py").read_text()) for name in NAMES}


def users_of(name):
    return {user for user, used in IMPORTS.items() if name in used}


def test_imports_are_found():
    assert imports_of("def f():\n    from flaunay import _plot, _graphs as g") == {
        "_plot",
        "_graphs",
    }
    assert imports_of("import flaunay._plot\nfrom flaunay._arrays import slices\nimport os") == {
        "_plot",
        "_arrays",
    }
    assert imports_of("from . import _calls\nfrom ._errors import Error") == {"_calls", "_errors"}
    assert "_calls" in IMPORTS["_delaunay"] and len(IMPORTS) > 20


def test_there_are_no_circles():
    # An error if there are any, that names the modules.
    tuple(graphlib.TopologicalSorter(IMPORTS).static_order())
    with pytest.raises(graphlib.CycleError):
        tuple(graphlib.TopologicalSorter({**IMPORTS, "_errors": {"_delaunay"}}).static_order())


def test_one_module_calls_the_library():
    """Besides the one that tells it where drivers are."""
    assert users_of("_library") == {"_calls", "_drivers"}


def test_classes_are_above_functions():
    for name in ("_export", "_graphs", "_plot", "_scipy"):
        assert IMPORTS[name] <= {"_arrays", "_calls", "_errors", "_optional"}


def test_the_help_names_everything():
    missing = [name for name in flaunay.__all__ if f"``{name}``" not in flaunay.__doc__]
    assert missing == ["__version__"]

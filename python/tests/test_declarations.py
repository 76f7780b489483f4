"""The declarations are made from flaunay.h; here is what that header does not say."""

import ctypes
import pathlib
import re

import numpy as np

from flaunay import _declarations

HEADER = pathlib.Path(__file__).parents[2] / "src" / "include" / "flaunay" / "flaunay.h"


def test_all_functions_are_declared():
    declared = re.findall(r"^FLAUNAY_API[^(]*?flaunay_(\w+)\(", HEADER.read_text(), re.MULTILINE)
    assert list(_declarations.FUNCTIONS) == declared and len(declared) > 100


def test_all_structs_have_all_their_members():
    text = re.sub(r"//[^\n]*", "", HEADER.read_text())
    bodies = re.findall(r"typedef struct flaunay_(\w+) \{(.*?)\n\} ", text, re.DOTALL)
    assert len(bodies) > 15
    for name, body in bodies:
        cls = getattr(_declarations, "".join(word.capitalize() for word in name.split("_")))
        assert len(cls._fields_) == body.count(";")


def test_the_sizes_that_numpy_has():
    assert np.dtype(np.intp).itemsize == ctypes.sizeof(ctypes.c_size_t) == 8

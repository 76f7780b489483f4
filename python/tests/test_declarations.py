"""What Python declares of the C interface is what flaunay.h declares."""

import ctypes
import pathlib
import re

import numpy as np
import pytest

from flaunay import _library

HEADER = pathlib.Path(__file__).parents[2] / "src" / "include" / "flaunay" / "flaunay.h"

# uintptr_t has the size of size_t, and ptrdiff_t that of ssize_t, everywhere where the library works.
NUMBERS = {
    "int": ctypes.c_int,
    "unsigned": ctypes.c_uint,
    "double": ctypes.c_double,
    "size_t": ctypes.c_size_t,
    "uintptr_t": ctypes.c_size_t,
    "ptrdiff_t": ctypes.c_ssize_t,
    "uint64_t": ctypes.c_uint64,
    "flaunay_status": ctypes.c_int,
    "void": None,
}


def without_comments(text):
    return re.sub(r"//[^\n]*", "", text)


def read_structs(text):
    """For each struct the types and names of its members, in their order."""
    structs = {}
    for name, body in re.findall(r"typedef struct (\w+) \{(.*?)\n\} \1;", text, re.DOTALL):
        structs[name] = [" ".join(member.split()) for member in body.split(";") if member.strip()]
    return structs


def read_functions(text):
    """For each function the type of its result, and those of its arguments."""
    functions = {}
    for result, name, given in re.findall(
        r"FLAUNAY_API ([\w* ]+?)\s*\bflaunay_(\w+)\(([^)]*)\);", text
    ):
        given = " ".join(given.split())
        arguments = [] if given == "void" else given.split(", ")
        functions[name] = result, [re.sub(r"\w+$", "", one).strip() for one in arguments]
    return functions


TEXT = without_comments(HEADER.read_text())
STRUCTS = read_structs(TEXT)
FUNCTIONS = read_functions(TEXT)
CLASSES = {
    cls.__name__: cls
    for cls in vars(_library).values()
    if isinstance(cls, type) and issubclass(cls, ctypes.Structure)
}


def struct_name(cls):
    return "flaunay" + re.sub("([A-Z])", lambda match: "_" + match[1].lower(), cls.__name__)


def is_pointer(declared):
    """Addresses: pointers and handles of OpenCL, which are pointers."""
    return declared.endswith("*") or declared.startswith("cl_")


def fits(declared, cls):
    """Whether a type of the header is that of ctypes."""
    plain = re.sub(r"\bconst\b", "", declared).replace(" ", "")
    if not is_pointer(declared):
        return NUMBERS[plain] is cls
    if cls is ctypes.c_char_p:
        return plain == "char*"
    if cls is ctypes.c_void_p:
        return plain != "char*"
    return plain == struct_name(cls._type_) + "*"


def function_fits(declared, cls):
    result, arguments = re.fullmatch(r"(\w+) \(\*\w+\)\((.*)\)", declared).groups()
    types = [re.sub(r"\w+$", "", one).strip() for one in arguments.split(", ")]
    return (
        fits(result, cls._restype_)
        and [len(types)] == [len(cls._argtypes_)]
        and all(map(fits, types, cls._argtypes_))
    )


def member_fits(declared, name, cls):
    if "(*" in declared:
        return f"(*{name})" in declared and function_fits(declared, cls)
    array = re.fullmatch(r"(.*?)(\w+)\[(\d+)\]", declared)
    if array:
        size = int(array[3])
        return array[2] == name and cls._length_ == size and fits(array[1].strip(), cls._type_)
    kind, declared_name = re.fullmatch(r"(.*?)(\w+)", declared).groups()
    return declared_name == name and fits(kind.strip(), cls)


def test_there_is_something_to_compare():
    assert len(CLASSES) >= 16 and len(STRUCTS) >= len(CLASSES) and len(FUNCTIONS) > 80
    assert FUNCTIONS["last_error_code"] == ("int", [])
    assert FUNCTIONS["triangulator_create"] == (
        "flaunay_status",
        ["const char*", "flaunay_triangulator**"],
    )
    assert STRUCTS["flaunay_phase"] == ["const char* name", "double seconds"]


@pytest.mark.parametrize("cls", CLASSES.values(), ids=CLASSES)
def test_structs(cls):
    members = STRUCTS[struct_name(cls)]
    assert len(members) == len(cls._fields_)
    for member, (name, kind) in zip(members, cls._fields_):
        assert member_fits(member, name, kind), (member, name, kind)


@pytest.mark.parametrize("name", _library.FUNCTIONS)
def test_functions(name):
    result, arguments = _library.FUNCTIONS[name]
    declared_result, declared = FUNCTIONS[name]
    assert fits(declared_result, result), (declared_result, result)
    assert len(declared) == len(arguments)
    for there, here in zip(declared, arguments):
        assert fits(there, here), (there, here)


@pytest.mark.parametrize(
    "enum, prefix, values",
    [
        ("flaunay_part", "FLAUNAY_PART_", {k.upper(): v for k, v in _library.PARTS.items()}),
        (
            "flaunay_voronoi_part",
            "FLAUNAY_VORONOI_",
            {k.upper(): v for k, v in _library.VORONOI_PARTS.items()},
        ),
        (
            "flaunay_clipped_voronoi_part",
            "FLAUNAY_CLIPPED_VORONOI_",
            {k.upper(): v for k, v in _library.CLIPPED_VORONOI_PARTS.items()},
        ),
        (
            "flaunay_interpolation",
            "FLAUNAY_INTERPOLATION_",
            {k.upper(): v for k, v in _library.INTERPOLATIONS.items()},
        ),
        (
            "flaunay_crossings",
            "FLAUNAY_CROSSINGS_",
            {k.upper(): v for k, v in _library.CROSSINGS.items()},
        ),
        (
            "flaunay_outside",
            "FLAUNAY_OUTSIDE_",
            {k.upper(): v for k, v in _library.OUTSIDE.items()},
        ),
        (
            "flaunay_fill_rule",
            "FLAUNAY_FILL_RULE_",
            {k.upper(): v for k, v in _library.FILL_RULES.items()},
        ),
        (
            "flaunay_overlaps",
            "FLAUNAY_OVERLAPS_",
            {k.upper(): v for k, v in _library.OVERLAPS.items()},
        ),
        (
            "flaunay_precision",
            "FLAUNAY_",
            {"FLOAT64": _library.FLOAT64, "FLOAT32": _library.FLOAT32},
        ),
        ("flaunay_index_type", "FLAUNAY_", {"INT32": _library.INT32, "INT64": _library.INT64}),
        (
            "flaunay_status",
            "FLAUNAY_",
            {
                name.lstrip("_"): value
                for name, value in vars(_library).items()
                if re.fullmatch("SUCCESS|_?ERROR_.*", name)
            },
        ),
    ],
)
def test_enumerators(enum, prefix, values):
    body = re.search(rf"typedef enum {enum} \{{(.*?)\}} {enum};", TEXT, re.DOTALL)[1]
    declared = {name: int(value) for name, value in re.findall(rf"{prefix}(\w+) =\s*(\d+)", body)}
    assert declared == values


def test_a_wrong_declaration_is_found():
    assert not fits("size_t", ctypes.c_int) and not fits("const char*", ctypes.c_void_p)
    assert not fits("const flaunay_phase*", ctypes.POINTER(_library.Kernel))
    assert not member_fits("uintptr_t reserved[4]", "reserved", ctypes.c_size_t * 8)
    assert not member_fits("double seconds", "second", ctypes.c_double)
    assert not function_fits("int (*progress)(const char* stage, void* data)", _library._Progress)


def test_the_sizes_that_numpy_has():
    assert np.dtype(np.intp).itemsize == ctypes.sizeof(ctypes.c_size_t) == 8

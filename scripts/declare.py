"""Writes what other languages know of the C interface, from its headers.

    declare.py FLAUNAY_H RESULT_ARRAYS_HPP OUTPUT...
    declare.py --words [--check]

An output's ending says what is written: .py: ctypes declarations and types of options for Python; .js: enumerators,
structs and tables of arrays for JavaScript; .ts: types of its enumerators and options; .h: a check that a compiler for
WebAssembly has these structs. --words: brings lists of enumerators' words in documents and docstrings up to date, those
of options and parameters that have the name of an enumeration; --check: fails if a word is missing.

Reads what those headers have, not C: what it does not know is an error. Names are those of the header without
`flaunay_`. Handles, arrays and OpenCL's handles are addresses. An int is one of an enumeration's numbers if its comment
says "a flaunay_...", and a flag if that says what is so "other than 0" or "1 if".
"""

from __future__ import annotations

import json
import os
import re
import sys
from pathlib import Path
from typing import NamedTuple, Optional

# uintptr_t has the size of size_t, and ptrdiff_t that of ssize_t, everywhere where the library works.
NUMBERS = {
    "int": "c_int",
    "unsigned": "c_uint",
    "double": "c_double",
    "size_t": "c_size_t",
    "uintptr_t": "c_size_t",
    "ptrdiff_t": "c_ssize_t",
    "int64_t": "c_int64",
    "uint64_t": "c_uint64",
    "flaunay_status": "c_int",
    "void": "None",
}
# In WebAssembly, whose addresses have 32 bits, these have two words, and all others one.
TWO_WORDS = ("double", "int64_t", "uint64_t")
# Of elements of arrays, as NumPy and as JavaScript name them. What has 8 bits and no sign is a flag.
ELEMENTS = {
    "double": ("float64", "float64"),
    "std::int8_t": ("int8", "int8"),
    "std::int32_t": ("int32", "int32"),
    "std::size_t": ("int64", "uint32"),
    "std::uint8_t": ("bool", "uint8"),
}

PYTHON_HEAD = '''"""The C interface of flaunay, as flaunay.h declares it. Written by scripts/declare.py."""

from __future__ import annotations

import ctypes
from ctypes import POINTER, c_char_p, c_double, c_int, c_int64, c_size_t, c_ssize_t, c_uint, c_uint64, c_void_p
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Optional, TypedDict

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import pyopencl.array

'''
# Structs whose options users of other languages give by their names.
OPTIONS = ("refinement", "constraints")
ABOUT_ARRAYS = "For each array its type, of what it has rows, the elements of a row, and what asks for it."
JAVASCRIPT_HEAD = """// What flaunay.h and result_arrays.hpp declare. Written by scripts/declare.py.

"""


def class_name(name: str) -> str:
    return "".join(word.capitalize() for word in name.split("_"))


def camel(name: str) -> str:
    kind = class_name(name)
    return kind[:1].lower() + kind[1:]


class Member(NamedTuple):
    """Of a struct."""

    name: str
    type: str  # of a function, that of its result
    length: int = 1
    arguments: Optional[str] = None  # of a function
    kind: str = ""  # "flag", or the name of an enumeration
    about: str = ""


def text_of(comment: str) -> str:
    return " ".join(re.sub(r"///<?", "", comment).split())


def sentence(comment: str) -> str:
    """The first one of a comment, without what a flag says of numbers."""
    text = re.sub(r"^[Oo]ther than 0: ", "", text_of(comment)).partition(". ")[0].rstrip(".")
    return text[:1].upper() + text[1:] + "."


class Header:
    """What flaunay.h has."""

    def __init__(self, text: str) -> None:
        about_enums = re.findall(r"((?:^/// .*\n)+)typedef enum flaunay_(\w+)", text, re.MULTILINE)
        self.about_enums = {name: sentence(comment) for comment, name in about_enums}
        about_parts = re.findall(r"((?:^ */// .*\n)+) *FLAUNAY_PART_(\w+) =", text, re.MULTILINE)
        self.about_parts = {name.lower(): text_of(comment) for comment, name in about_parts}
        documented = dict(re.findall(r"typedef struct flaunay_(\w+) \{\n(.*?)\} flaunay_\1;", text, re.DOTALL))
        text = " ".join(re.sub(r"//[^\n]*|^#.*?$", "", text, flags=re.MULTILINE).split())
        enums = re.findall(r"typedef enum flaunay_(\w+) \{(.*?)\} flaunay_\1;", text)
        self.functions = re.findall(r"FLAUNAY_API ([\w* ]+?) ?\bflaunay_(\w+)\(([^)]*)\);", text)
        if not (enums and documented and self.functions):
            raise SystemExit("declare: the header is not as expected")
        self.enums = {name: self.values(body) for name, body in enums}
        self.structs = {name: self.members(body) for name, body in documented.items()}

    @staticmethod
    def values(body: str) -> dict[str, int]:
        """Of enumerators, without the words that all of them begin with."""
        values = re.findall(r"(\w+) = (\d+)", body)
        prefix = os.path.commonprefix([name for name, _ in values]).rpartition("_")[0] + "_"
        return {name[len(prefix):].lower(): int(value) for name, value in values}

    @staticmethod
    def members(body: str) -> list[Member]:
        members = []
        for before, member, after in re.findall(r"((?:^ */// .*\n)*)([^;/]+);((?: *///< .*\n)*)", body, re.MULTILINE):
            declared, comment = " ".join(member.split()), before + after
            function = re.fullmatch(r"(\w+) \(\*(\w+)\)\((.*)\)", declared)
            if function:
                members.append(Member(function[2], function[1], arguments=function[3]))
                continue
            ((kind, name, length),) = re.findall(r"^(.*?)(\w+)(?:\[(\d+)\])?$", declared)
            of = re.search(r"\ba flaunay_(\w+)|([Oo]ther than 0|\b1 if)\b", comment)
            is_one = kind.strip() == "int" and of is not None and not name.startswith("has_")
            kind_of = (of[1] or "flag") if is_one else ""
            members.append(Member(name, kind.strip(), int(length or 1), None, kind_of, sentence(comment)))
        return members

    def options(self, struct: str) -> list[Member]:
        """The members that users of other languages give by the same names: numbers, flags and words."""
        return [
            member
            for member in self.structs[struct]
            if member.kind in ("flag", member.name)
            or (member.type in ("double", "size_t") and not member.name.endswith("_count"))
        ]


class Array(NamedTuple):
    """A row of a table of arrays."""

    name: str
    type: str
    row: str
    columns: int
    asked: str


def tables_of(text: str) -> dict[str, list[Array]]:
    """The tables of result_arrays.hpp. Of one that has names alone, arrays have no type."""
    tables = {}
    for table, body in re.findall(r"#define FLAUNAY_(\w+)_ARRAYS\(X\)((?:.*\\\n)*.*\n)", text):
        rows = re.findall(r"X\(([\w:]+), (\w+), (\w+), (\d)(?:, (\w+))?", body)
        tables[table] = [
            Array(name, kind, row, int(columns), asked or "always")
            for kind, name, row, columns, asked in rows
        ] or [Array(name, "", "", 0, "") for name in re.findall(r"X\((\w+)\)", body)]
    return tables


# ---- Python


class Python:
    def __init__(self, header: Header) -> None:
        self.header = header

    def type_of(self, declared: str) -> str:
        """Of a type, without a name."""
        plain = re.sub(r"\bconst\b", "", declared).replace(" ", "")
        if plain == "char*":
            return "c_char_p"
        struct = re.fullmatch(r"flaunay_(\w+)\*", plain)
        if struct and struct[1] in self.header.structs:
            return f"POINTER({class_name(struct[1])})"
        if plain.endswith("*") or plain.startswith("cl_"):
            return "c_void_p"
        return NUMBERS[plain]

    def argument_types(self, declared: str) -> list[str]:
        """Of a list of arguments with their names."""
        if declared == "void":
            return []
        return [self.type_of(re.sub(r"\w+$", "", one)) for one in declared.split(", ")]

    def struct(self, name: str, members: list[Member]) -> str:
        callbacks, fields = "", ""
        for member in members:
            kind = self.type_of(member.type)
            if member.arguments is not None:
                types = [kind, *self.argument_types(member.arguments)]
                kind = class_name(name) + class_name(member.name)
                callbacks += f"{kind} = ctypes.CFUNCTYPE({', '.join(types)})\n"
            elif member.name == "reserved":
                kind += f" * {member.length}"
            fields += f'        ("{member.name}", {kind}),\n'
        return f"{callbacks}\n\nclass {class_name(name)}(ctypes.Structure):\n    _fields_ = [\n{fields}    ]\n"

    def options(self, name: str) -> dict[str, str]:
        """The types of a struct's options."""
        types, names = {}, {member.name for member in self.header.structs[name]}
        for member in self.header.options(name):
            kind = {"double": "float", "size_t": "int", "flag": "bool"}.get(member.kind or member.type, "str")
            types[member.name] = f"Optional[{kind}]" if f"has_{member.name}" in names else kind
        return types

    @staticmethod
    def keywords(name: str, types: dict[str, str]) -> str:
        members = "".join(f"    {member}: {kind}\n" for member, kind in types.items())
        return f"\n\nclass {class_name(name)}Options(TypedDict, total=False):\n{members}"

    @staticmethod
    def attributes(name: str, about: str, types: dict[str, str]) -> str:
        members = "".join(f"    {member}: {kind}\n" for member, kind in types.items())
        head = "@dataclass(frozen=True, eq=False, repr=False)"
        return f'\n\n{head}\nclass {name}:\n    """{about}"""\n\n{members}'

    def triangulation(self, arrays: list[Array]) -> str:
        """What classes have that have the arrays of triangulations, and the keywords that ask for these."""
        in_memory, on_device = {}, {}
        for name, kind, _, _, asked in arrays:
            array = f"npt.NDArray[np.{ELEMENTS[kind][0]}]"
            in_memory[name] = array if asked == "always" else f"Optional[{array}]"
            on_device[name] = "Optional[pyopencl.array.Array]"
        on_device["triangles"] = "pyopencl.array.Array"
        wanted = {array.name: "bool" for array in arrays if array.asked == "on_request"}
        parts = {array.name: "bool" for array in arrays if array.name != "triangles"}
        return (
            self.keywords("triangulation", wanted)
            + self.keywords("device_triangulation", parts)
            + self.attributes("TriangulationArrays", "The arrays of triangulations.", in_memory)
            + self.attributes("DeviceTriangulationArrays", "The arrays of triangulations in device memory.", on_device)
        )

    def function(self, result: str, name: str, arguments: str) -> str:
        types = ", ".join(self.argument_types(arguments))
        return f'    "{name}": ({self.type_of(result)}, [{types}]),\n'

    def write(self, tables: dict[str, list[Array]]) -> str:
        header = self.header
        lines = [f"{name.upper()} = {json.dumps(values)}\n" for name, values in header.enums.items()]
        lines += [self.struct(*one) for one in header.structs.items()]
        flags = {
            class_name(name): [member.name for member in members if member.kind == "flag"]
            for name, members in header.structs.items()
        }
        lines += [f"\n\n# Members that are 0 or not.\nFLAGS = {json.dumps(flags)}\n"]
        lines += [self.keywords(name, self.options(name)) for name in OPTIONS]
        lines += [self.triangulation(tables["TRIANGULATION"])]
        lines += ["\n\n# The type of the result, and those of the arguments.\n"]
        lines += ["FUNCTIONS: dict[str, tuple[Any, list[Any]]] = {\n"]
        lines += [self.function(*one) for one in header.functions] + ["}\n"]
        lines += [f"\n# {ABOUT_ARRAYS}\n"]
        for table, arrays in tables.items():
            if not arrays[0].type:
                lines += [f"{table}_ARRAYS = {[array.name for array in arrays]}\n"]
                continue
            lines += [f"{table}_ARRAYS: dict[str, tuple[str, str, int, str]] = {{\n"]
            for name, kind, row, columns, asked in arrays:
                lines += [f'    "{name}": ("{ELEMENTS[kind][0]}", "{row}", {columns}, "{asked}"),\n']
            lines += ["}\n"]
        return PYTHON_HEAD + "".join(lines)


# ---- JavaScript


def words_of(values: dict[str, int]) -> list[str]:
    return [name.replace("_", "-") for name in values]


class Layout(NamedTuple):
    """Where a struct has those of its members that are one word, in words, and doubles, in their size."""

    places: dict[str, int]
    doubles: dict[str, int]
    words: int


def layout_of(members: list[Member]) -> Layout:
    places, doubles, end, alignment = {}, {}, 0, 1
    for member in members:
        size = 2 if member.type in TWO_WORDS else 1
        end, alignment = -(-end // size) * size, max(size, alignment)
        if member.type == "double":
            doubles[member.name] = end // 2
        elif size == 1 and member.name != "reserved":
            places[member.name] = end
        end += size * member.length
    return Layout(places, doubles, -(-end // alignment) * alignment)


def javascript(header: Header, tables: dict[str, list[Array]]) -> str:
    text = "// The words of enumerators, by their numbers, or the numbers that do not count up from 0.\n"
    for name, values in header.enums.items():
        counts_up = list(values.values()) == list(range(len(values)))
        shown = words_of(values) if counts_up else {camel(key): bit for key, bit in values.items()}
        text += f"export const {name.upper()} = {json.dumps(shown)};\n"
    text += "\n// How many words of 32 bits a struct has, where it has those members that are one, and doubles, by their size;\n"
    text += "// the enumerations of members that are words for users, and flags.\n"
    for name, members in header.structs.items():
        layout = layout_of(members)
        at, doubles = ({camel(key): place for key, place in places.items()} for places in layout[:2])
        kinds = {camel(member.name): member.kind for member in members if member.kind}
        shown = {"words": layout.words, "at": at, "doubles": doubles, "kinds": kinds}
        text += f"export const {class_name(name)} = {json.dumps(shown)};\n"
    text += f"\n// {ABOUT_ARRAYS}\n"
    for table, arrays in tables.items():
        if arrays[0].type:
            rows = {
                camel(name): (ELEMENTS[kind][1], row, *others) for name, kind, row, *others in arrays
            }
            text += f"export const {table}_ARRAYS = {json.dumps(rows)};\n"
    return JAVASCRIPT_HEAD + text


def interface(name: str, members: dict[str, tuple[str, str]]) -> str:
    """members: the type of each and what it is about."""
    lines = "".join(f"  /** {about} */\n  {member}: {kind};\n" for member, (kind, about) in members.items())
    return f"export interface {name} {{\n{lines}}}\n"


def typescript(header: Header, tables: dict[str, list[Array]]) -> str:
    lines = ""
    for name, values in header.enums.items():
        lines += f"export type {class_name(name)} = {' | '.join(map(repr, words_of(values)))};\n"
    for struct in ("constraints", "polygons"):
        options = {}
        for name, _, _, _, kind, about in header.options(struct):
            is_word = kind != "flag"
            options[f"{camel(name)}?"] = (
                class_name(kind) if is_word else "boolean", header.about_enums[kind] if is_word else about
            )
        lines += interface(f"{class_name(struct)}Options", options)
    views, wanted = {}, {}
    for name, kind, _, _, asked in tables["TRIANGULATION"]:
        views[f"readonly {camel(name)}"] = f"{ELEMENTS[kind][1].capitalize()}Array", header.about_parts[name]
        if asked == "on_request":
            wanted[f"{camel(name)}?"] = "boolean", f"Whether {name} are computed."
    lines += interface("TriangulationArrays", views) + interface("TriangulationOptions", wanted)
    return JAVASCRIPT_HEAD + lines


def layout_check(header: Header, _: dict[str, list[Array]]) -> str:
    lines = '#include "flaunay/flaunay.h"\n\n'
    for name, members in header.structs.items():
        layout = layout_of(members)
        lines += f"static_assert(sizeof(flaunay_{name}) == {4 * layout.words});\n"
        for size, places in (4, layout.places), (8, layout.doubles):
            for member, place in places.items():
                lines += f"static_assert(offsetof(flaunay_{name}, {member}) == {size * place});\n"
    return JAVASCRIPT_HEAD + lines


# ---- Lists of words in documents

# Parameters and options that are named otherwise than the enumeration.
NAMED = {"keep_edges": "kept_edges", "fill": "fill_rule"}
DOCUMENTS = {"docs/*.md": r"--([\w-]+) ([\w-]+(?:\\\|[\w-]+)+)", "python/flaunay/*.py": r"( {4}\w+) : \{(\".+?\")\}"}


def with_all_words(header: Header, match: re.Match[str]) -> str:
    """A list of words with those that it lacks at its end, if it is one of an enumeration of its name."""
    text, name, listed = match[0], match[1].strip().replace("-", "_"), match[2]
    words = list(header.enums.get(NAMED.get(name, name), []))
    is_python = listed.startswith('"')
    there = re.findall(r"[\w-]+", listed)
    if not is_python:
        words = [word.replace("_", "-") for word in words]
    if not set(there) <= set(words):
        return text
    words.sort(key=lambda word: there.index(word) if word in there else len(there))
    return text.replace(listed, ", ".join(f'"{word}"' for word in words) if is_python else "\\|".join(words))


def bring_words_up_to_date(check: bool) -> None:
    root = Path(__file__).resolve().parent.parent
    header = Header((root / "src/include/flaunay/flaunay.h").read_text(encoding="utf-8"))
    for files, pattern in DOCUMENTS.items():
        for path in sorted(root.glob(files)):
            text = path.read_text(encoding="utf-8")
            changed = re.sub(pattern, lambda match: with_all_words(header, match), text)
            if changed != text and check:
                raise SystemExit(f"declare: {path} does not list all words: scripts/format.sh adds them")
            if changed != text:
                path.write_text(changed, encoding="utf-8")


WRITERS = {
    ".py": lambda header, tables: Python(header).write(tables),
    ".js": javascript,
    ".ts": typescript,
    ".h": layout_check,
}


def main(header: str, arrays: str, *outputs: str) -> None:
    declared, tables = Header(Path(header).read_text()), tables_of(Path(arrays).read_text())
    for output in map(Path, outputs):
        output.write_text(WRITERS[output.suffix](declared, tables))


if __name__ == "__main__":
    if sys.argv[1:2] == ["--words"]:
        bring_words_up_to_date("--check" in sys.argv)
    else:
        main(*sys.argv[1:])

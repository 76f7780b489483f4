"""Writes what other languages know of the C interface, from its headers.

    declare.py FLAUNAY_H RESULT_ARRAYS_HPP OUTPUT...

An output's ending says what is written: .py: ctypes declarations for Python; .js: enumerators, structs and tables of
arrays for JavaScript; .ts: types of its enumerators; .h: a check that a compiler for WebAssembly has these structs.

Reads what those headers have, not C: what it does not know is an error. Names are those of the header without
`flaunay_`. Handles, arrays and OpenCL's handles are addresses.
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
from typing import Any

'''
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


class Header:
    """What flaunay.h has."""

    def __init__(self, text: str) -> None:
        text = " ".join(re.sub(r"//[^\n]*|^#.*?$", "", text, flags=re.MULTILINE).split())
        enums = re.findall(r"typedef enum flaunay_(\w+) \{(.*?)\} flaunay_\1;", text)
        structs = re.findall(r"typedef struct flaunay_(\w+) \{(.*?)\} flaunay_\1;", text)
        self.functions = re.findall(r"FLAUNAY_API ([\w* ]+?) ?\bflaunay_(\w+)\(([^)]*)\);", text)
        if not (enums and structs and self.functions):
            raise SystemExit("declare: the header is not as expected")
        self.enums = {name: self.values(body) for name, body in enums}
        self.structs = {name: self.members(body) for name, body in structs}

    @staticmethod
    def values(body: str) -> dict[str, int]:
        """Of enumerators, without the words that all of them begin with."""
        values = re.findall(r"(\w+) = (\d+)", body)
        prefix = os.path.commonprefix([name for name, _ in values]).rpartition("_")[0] + "_"
        return {name[len(prefix):].lower(): int(value) for name, value in values}

    @staticmethod
    def members(body: str) -> list[Member]:
        members = []
        for member in filter(None, (one.strip() for one in body.split(";"))):
            function = re.fullmatch(r"(\w+) \(\*(\w+)\)\((.*)\)", member)
            if function:
                members.append(Member(function[2], function[1], arguments=function[3]))
                continue
            ((declared, name, length),) = re.findall(r"^(.*?)(\w+)(?:\[(\d+)\])?$", member)
            members.append(Member(name, declared.strip(), int(length or 1)))
        return members


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

    def function(self, result: str, name: str, arguments: str) -> str:
        types = ", ".join(self.argument_types(arguments))
        return f'    "{name}": ({self.type_of(result)}, [{types}]),\n'

    def write(self, tables: dict[str, list[Array]]) -> str:
        header = self.header
        lines = [f"{name.upper()} = {json.dumps(values)}\n" for name, values in header.enums.items()]
        lines += [self.struct(*one) for one in header.structs.items()]
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


def layout_of(members: list[Member]) -> tuple[dict[str, int], int]:
    """Where a struct has those of its members that are one word, in words, and how many words it has."""
    places, end, alignment = {}, 0, 1
    for member in members:
        size = 2 if member.type in TWO_WORDS else 1
        end, alignment = -(-end // size) * size, max(size, alignment)
        if size == 1 and member.name != "reserved":
            places[member.name] = end
        end += size * member.length
    return places, -(-end // alignment) * alignment


def javascript(header: Header, tables: dict[str, list[Array]]) -> str:
    text = "// The words of enumerators, by their numbers, or the numbers that do not count up from 0.\n"
    for name, values in header.enums.items():
        counts_up = list(values.values()) == list(range(len(values)))
        shown = words_of(values) if counts_up else {camel(key): bit for key, bit in values.items()}
        text += f"export const {name.upper()} = {json.dumps(shown)};\n"
    text += "\n// How many words of 32 bits a struct has, and where it has those members that are one.\n"
    for name, members in header.structs.items():
        places, size = layout_of(members)
        at = {camel(key): place for key, place in places.items()}
        text += f"export const {class_name(name)} = {json.dumps({'words': size, 'at': at})};\n"
    text += f"\n// {ABOUT_ARRAYS}\n"
    for table, arrays in tables.items():
        if arrays[0].type:
            rows = {
                camel(name): (ELEMENTS[kind][1], row, *others) for name, kind, row, *others in arrays
            }
            text += f"export const {table}_ARRAYS = {json.dumps(rows)};\n"
    return JAVASCRIPT_HEAD + text


def typescript(header: Header, _: dict[str, list[Array]]) -> str:
    lines = ""
    for name, values in header.enums.items():
        lines += f"export type {class_name(name)} = {' | '.join(map(repr, words_of(values)))};\n"
    return JAVASCRIPT_HEAD + lines


def layout_check(header: Header, _: dict[str, list[Array]]) -> str:
    lines = '#include "flaunay/flaunay.h"\n\n'
    for name, members in header.structs.items():
        places, size = layout_of(members)
        lines += f"static_assert(sizeof(flaunay_{name}) == {4 * size});\n"
        for member, place in places.items():
            lines += f"static_assert(offsetof(flaunay_{name}, {member}) == {4 * place});\n"
    return JAVASCRIPT_HEAD + lines


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
    main(*sys.argv[1:])

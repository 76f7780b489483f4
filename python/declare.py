"""Writes the ctypes declarations of the C interface, flaunay/_declarations.py, from its headers.

    declare.py FLAUNAY_H RESULT_ARRAYS_HPP OUTPUT

Reads what those headers have, not C: what it does not know is an error. Names are those of the header without
`flaunay_`. Handles, arrays and OpenCL's handles are addresses.
"""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path

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
# Of elements of arrays, as NumPy names them. What has 8 bits and no sign is a flag.
ELEMENTS = {
    "double": "float64",
    "std::int8_t": "int8",
    "std::int32_t": "int32",
    "std::size_t": "int64",
    "std::uint8_t": "bool",
}

HEAD = '''"""The C interface of flaunay, as flaunay.h declares it. Written by python/declare.py."""

from __future__ import annotations

import ctypes
from ctypes import POINTER, c_char_p, c_double, c_int, c_int64, c_size_t, c_ssize_t, c_uint, c_uint64, c_void_p
from typing import Any

'''


def class_name(name: str) -> str:
    return "".join(word.capitalize() for word in name.split("_"))


class Header:
    def __init__(self, text: str) -> None:
        text = " ".join(re.sub(r"//[^\n]*|^#.*?$", "", text, flags=re.MULTILINE).split())
        self.enums = re.findall(r"typedef enum flaunay_(\w+) \{(.*?)\} flaunay_\1;", text)
        self.structs = re.findall(r"typedef struct flaunay_(\w+) \{(.*?)\} flaunay_\1;", text)
        self.functions = re.findall(r"FLAUNAY_API ([\w* ]+?) ?\bflaunay_(\w+)\(([^)]*)\);", text)
        self.struct_names = {name for name, _ in self.structs}

    def type_of(self, declared: str) -> str:
        """Of a type, without a name."""
        plain = re.sub(r"\bconst\b", "", declared).replace(" ", "")
        if plain == "char*":
            return "c_char_p"
        struct = re.fullmatch(r"flaunay_(\w+)\*", plain)
        if struct and struct[1] in self.struct_names:
            return f"POINTER({class_name(struct[1])})"
        if plain.endswith("*") or plain.startswith("cl_"):
            return "c_void_p"
        return NUMBERS[plain]

    def argument_types(self, declared: str) -> list[str]:
        """Of a list of arguments with their names."""
        if declared == "void":
            return []
        return [self.type_of(re.sub(r"\w+$", "", one)) for one in declared.split(", ")]

    def enum(self, name: str, body: str) -> str:
        values = dict(re.findall(r"(\w+) = (\d+)", body))
        prefix = os.path.commonprefix(list(values)).rpartition("_")[0] + "_"
        entries = ", ".join(
            f'"{key[len(prefix):].lower()}": {value}' for key, value in values.items()
        )
        return f"{name.upper()} = {{{entries}}}\n"

    def struct(self, name: str, body: str) -> str:
        callbacks, fields = "", ""
        for member in filter(None, (one.strip() for one in body.split(";"))):
            function = re.fullmatch(r"(\w+) \(\*(\w+)\)\((.*)\)", member)
            array = re.fullmatch(r"(\w+) (\w+)\[(\d+)\]", member)
            if function:
                kind, key = class_name(name) + class_name(function[2]), function[2]
                types = [self.type_of(function[1]), *self.argument_types(function[3])]
                callbacks += f"{kind} = ctypes.CFUNCTYPE({', '.join(types)})\n"
            elif array:
                kind, key = f"{self.type_of(array[1])} * {array[3]}", array[2]
            else:
                declared, key = re.fullmatch(r"(.*?)(\w+)", member).groups()  # type: ignore[union-attr]
                kind = self.type_of(declared)
            fields += f'        ("{key}", {kind}),\n'
        return f"{callbacks}\n\nclass {class_name(name)}(ctypes.Structure):\n    _fields_ = [\n{fields}    ]\n"

    def function(self, result: str, name: str, arguments: str) -> str:
        types = ", ".join(self.argument_types(arguments))
        return f'    "{name}": ({self.type_of(result)}, [{types}]),\n'

    def declarations(self) -> str:
        if not (self.enums and self.structs and self.functions):
            raise SystemExit("declare: the header is not as expected")
        lines = [self.enum(*one) for one in self.enums] + [
            self.struct(*one) for one in self.structs
        ]
        lines += ["\n\n# The type of the result, and those of the arguments.\n"]
        lines += ["FUNCTIONS: dict[str, tuple[Any, list[Any]]] = {\n"]
        return "".join(lines + [self.function(*one) for one in self.functions]) + "}\n"


def arrays_of(text: str) -> str:
    """The tables of arrays, each with its type, what has one row per thing, elements per row, and who asks.

    Of a table that has names alone, these.
    """
    tables = "\n# For each array its type, of what it has rows, the elements of a row, and what asks for it.\n"
    for table, body in re.findall(r"#define FLAUNAY_(\w+)_ARRAYS\(X\)((?:.*\\\n)*.*\n)", text):
        rows = re.findall(r"X\(([\w:]+), (\w+), (\w+), (\d)(?:, (\w+))?", body)
        if rows:
            tables += f"{table}_ARRAYS: dict[str, tuple[str, str, int, str]] = {{\n"
            for kind, name, row, columns, asked in rows:
                tables += f'    "{name}": ("{ELEMENTS[kind]}", "{row}", {columns}, "{asked or "always"}"),\n'
            tables += "}\n"
        else:
            names = re.findall(r"X\((\w+)\)", body)
            tables += f"{table}_ARRAYS = {names}\n"
    return tables


def main(header: str, arrays: str, output: str) -> None:
    text = (
        HEAD + Header(Path(header).read_text()).declarations() + arrays_of(Path(arrays).read_text())
    )
    Path(output).write_text(text)


if __name__ == "__main__":
    main(*sys.argv[1:])

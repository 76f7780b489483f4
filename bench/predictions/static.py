#!/usr/bin/env python3
"""Compiles kernels for GPUs that this machine need not have, and prints what each kernel uses of them: registers,
stack, spills and local memory, by architecture.

    bench/predictions/static.py                                   all files and architectures; in fixed point, too
    bench/predictions/static.py blocks/divide.cl --arch sm_90      some
    bench/predictions/static.py --json bench/results/static.json   and a record, which predict.py reads

Clang compiles OpenCL C with the functions of libclc, in place of a vendor's driver, which is LLVM too but another
version. Registers of a kernel differ by up to a third from one version of Clang to another, so a record names its
compilers and is made as a whole. NVIDIA's machine code comes from ptxas, AMD's from Clang itself. What is not
installed is skipped, and standard error says what to install:

    apt-get install clang-19 libclc-19      (other versions will do)
    ptxas                                   of any CUDA toolkit, or pip install nvidia-cuda-nvcc
"""
import argparse
import glob
import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import time

KERNELS = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..", "kernels"))
ARCHITECTURES = ["sm_90", "sm_89", "gfx942"]
# As Runtime compiles for a GPU; src/tuning/tuning.cpp has the values.
OPTIONS = ["-cl-std=CL1.2", "-DSORT_BITS=4", "-DSORT_GROUP=128", "-DSMALL_REGION=48", "-DFETCH_AHEAD=0"]
COMMON = ["-x", "cl", "-O3", "-Xclang", "-finclude-default-header", f"-I{KERNELS}", "-Wno-everything",
          "-Dcl_khr_fp64", "-Dcl_khr_int64_base_atomics"]
# The folders of kernels that have a text in fixed point.
FIXED_POINT_FOLDERS = ("blocks", "constrained", "locate", "points")
ONE_TEXT = {"call/self_test_fixed.cl": True, "locate/fixed_point.cl": True, "constrained/seeds.cl": False}
NEWEST, OLDEST = 25, 14
COLUMNS = ["registers", "stack", "spills", "local_memory"]


class Missing(Exception):
    """Something that is not installed."""


def note(message):
    print(f"static.py: {message}", file=sys.stderr)


def run(command, what):
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise RuntimeError(f"{what} failed: {(result.stderr or result.stdout).strip().splitlines()[:3]}")
    return result.stdout + result.stderr


def version_of(program):
    """As "19.1.7" of Clang, or "13.0.88" of ptxas."""
    return re.search(r"(?:version |V)(\d[\d.]*)", run([program, "--version"], program))[1]


def version_of_bitcode(path):
    """The main version of the LLVM that wrote it, which stands before its target."""
    with open(path, "rb") as file:
        found = re.search(rb"(\d\d)\.\d+\.\d+(?:amdgcn|nvptx64)-", file.read())
    return found and found[1].decode()


def clang_with(name, target, architecture):
    """The newest clang that knows the architecture and has libclc's functions of its own version, and these."""
    names = [*(f"clang-{version}" for version in range(NEWEST, OLDEST, -1)), "clang"]
    for clang in filter(None, map(shutil.which, names)):
        version = version_of(clang).split(".")[0]
        # Links are not followed: some packages' lead back to their folder.
        builtins = [path for top in (f"/usr/lib/llvm-{version}", "/usr/lib/clc", "/usr/local/share/clc")
                    for folder, _, _ in os.walk(top)
                    for path in glob.glob(os.path.join(folder, f"{name}.bc")) if version_of_bitcode(path) == version]
        check = [clang, "-x", "cl", "-target", target, "-Xclang", "-target-cpu", "-Xclang", architecture, "-nogpulib",
                 "-S", "-o", os.devnull, os.devnull]
        if builtins and subprocess.run(check, capture_output=True, check=False).returncode == 0:
            return clang, builtins[0]
    raise Missing(f"no clang that knows it and has libclc with {name}.bc; apt-get install clang-19 libclc-19")


def find_ptxas():
    paths = [os.environ.get("PTXAS"), shutil.which("ptxas"), "/usr/local/cuda/bin/ptxas"]
    for folder in {sysconfig.get_paths()["purelib"], *filter(os.path.isdir, sys.path)}:
        paths += glob.glob(os.path.join(folder, "nvidia", "*", "bin", "ptxas"))
    for path in paths:
        if path and os.access(path, os.X_OK):
            return path
    raise Missing("no ptxas; a CUDA toolkit has one, or pip install nvidia-cuda-nvcc (PTXAS=... names another)")


def rows_of_ptxas(log):
    rows = []
    for part in log.split("Compiling entry function '")[1:]:
        numbers = {name: sum(map(int, re.findall(pattern, part))) for name, pattern in (
            ("registers", r"Used (\d+) registers"), ("stack", r"(\d+) bytes stack frame"),
            ("spills", r"(\d+) bytes spill (?:stores|loads)"), ("local_memory", r"(\d+) bytes smem"))}
        rows.append({"kernel": part[:part.index("'")], **numbers})
    return rows


def rows_of_metadata(assembly):
    """Of AMD's assembly. Spills count registers' lanes of 4 bytes, to be comparable with bytes."""
    rows = []
    metadata = assembly[assembly.index("amdhsa.kernels:"):]
    for part in re.split(r"\n  - ", metadata)[1:]:
        values = dict(re.findall(r"^\s*\.(\w+):\s+'?([\w.]+)'?\s*$", part, re.MULTILINE))
        if "vgpr_count" not in values:
            continue
        # The arguments have names, too; the kernel's stands beside its symbol.
        name = values["symbol"].removesuffix(".kd") if "symbol" in values else values["name"]
        rows.append({"kernel": name, "registers": int(values["vgpr_count"]),
                     "stack": int(values["private_segment_fixed_size"]),
                     "spills": 4 * (int(values["vgpr_spill_count"]) + int(values.get("sgpr_spill_count", 0))),
                     "local_memory": int(values["group_segment_fixed_size"])})
    return rows


class Compiler:
    """NVIDIA's by way of PTX, or AMD's by Clang alone."""

    def __init__(self, architecture):
        self.architecture = architecture
        self.is_nvidia = architecture.startswith("sm_")
        name, target = (("nvptx64--nvidiacl", "nvptx64-nvidia-nvcl") if self.is_nvidia else ("amdgcn--amdhsa",) * 2)
        clang, builtins = clang_with(name, target, architecture)
        cpu = ["-Xclang", "-target-cpu", "-Xclang", architecture]
        self.command = [clang, *COMMON, "-target", target, *(cpu if self.is_nvidia else [f"-mcpu={architecture}"]),
                        "-nogpulib", "-Xclang", "-mlink-builtin-bitcode", "-Xclang", builtins]
        self.ptxas = find_ptxas() if self.is_nvidia else None
        self.versions = {"clang": version_of(clang), **({"ptxas": version_of(self.ptxas)} if self.is_nvidia else {})}

    def compile(self, file, folder, options):
        assembly = os.path.join(folder, "kernel.s")
        run([*self.command, *options, "-S", "-o", assembly, file], "clang")
        if self.is_nvidia:
            arch = f"-arch={self.architecture}"
            return rows_of_ptxas(run([self.ptxas, "-v", arch, "-o", os.devnull, assembly], "ptxas"))
        with open(assembly, encoding="utf-8") as text:
            return rows_of_metadata(text.read())


def texts_of(file):
    """Whether each text of the file is in fixed point."""
    return [ONE_TEXT[file]] if file in ONE_TEXT else [False, True][:1 + (file.split(os.sep)[0] in FIXED_POINT_FOLDERS)]


def table_of(files, architectures):
    """Rows, the versions of compilers by architecture, and how many files failed."""
    rows, compilers, failures = [], {}, 0
    for architecture in architectures:
        try:
            compiler = Compiler(architecture)
        except Missing as missing:
            note(f"{architecture} is skipped: {missing}")
            continue
        compilers[architecture] = compiler.versions
        for file, fixed_point in [(file, text) for file in files for text in texts_of(file)]:
            begin = time.monotonic()
            try:
                with tempfile.TemporaryDirectory() as folder:
                    options = OPTIONS + ["-DFIXED_POINT"] * fixed_point
                    compiled = compiler.compile(os.path.join(KERNELS, file), folder, options)
            except RuntimeError as error:
                note(f"{file} for {architecture}: {error}")
                failures += 1
                continue
            seconds = round(time.monotonic() - begin, 2)
            rows += [{"architecture": architecture, "file": file, "fixed_point": fixed_point, **row,
                      "file_seconds": seconds} for row in sorted(compiled, key=lambda row: row["kernel"])]
    return rows, compilers, failures


def print_table(rows):
    """A row a kernel; of each architecture: registers, stack, spills, local memory."""
    architectures = list(dict.fromkeys(row["architecture"] for row in rows))
    kernels = {}
    for row in rows:
        cells = kernels.setdefault((row["file"], row["kernel"], row["fixed_point"]), dict.fromkeys(architectures, "-"))
        cells[row["architecture"]] = " / ".join(str(row[column]) for column in COLUMNS)
    print("| kernel | " + " | ".join(architectures) + " |")
    print("|---|" + "--:|" * len(architectures))
    for (_, kernel, fixed_point), cells in kernels.items():
        print(f"| `{kernel}`{', in fixed point' * fixed_point} | {' | '.join(cells.values())} |")


def main(command_line):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", metavar="FILE", nargs="*",
                        help="below kernels/, such as blocks/divide.cl; by default all")
    parser.add_argument("--arch", metavar="NAME", action="append", default=[],
                        help=f"sm_... or gfx...; by default {', '.join(ARCHITECTURES)}")
    parser.add_argument("--json", metavar="FILE", help="write a record here")
    arguments = parser.parse_args(command_line)
    files = arguments.files or sorted(os.path.relpath(path, KERNELS)
                                      for path in glob.glob(os.path.join(KERNELS, "*", "*.cl")))
    rows, compilers, failures = table_of(files, arguments.arch or ARCHITECTURES)
    if not rows:
        note("nothing was compiled")
        return 1
    print("registers / bytes of stack / bytes of spills / bytes of local memory\n")
    print_table(rows)
    if arguments.json:
        text = ",\n".join("    " + json.dumps(row) for row in rows)
        with open(arguments.json, "w", encoding="utf-8") as file:
            file.write(f'{{\n  "compilers": {json.dumps(compilers)},\n  "options": {json.dumps(OPTIONS)},\n'
                       f'  "results": [\n{text}\n  ]\n}}\n')
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

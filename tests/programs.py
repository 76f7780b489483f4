"""Runs Python programs one after the other: programs.py FOLDER PROGRAM.py...

Each runs in FOLDER, as a child of a process that has imported what takes long to import. What PROGRAM.py prints is in
PROGRAM.printed beside it, which there is only if it has succeeded.
"""

import contextlib
import os
import pathlib
import runpy
import sys
import traceback

for package in "numpy", "matplotlib.pyplot", "pyopencl.array", "flaunay":
    with contextlib.suppress(ImportError):
        __import__(package)


def run(program, *arguments, folder=".", output=None):
    """The exit status of a program. output: where what it prints goes."""
    sys.stdout.flush()
    child = os.fork()
    if child != 0:
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    if output is not None:
        os.dup2(os.open(output, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o666), sys.stdout.fileno())
    os.chdir(folder)
    sys.argv = [str(program), *map(str, arguments)]
    sys.path[0] = str(program.parent)
    try:
        runpy.run_path(str(program), run_name="__main__")
    except SystemExit:
        raise
    except BaseException:
        traceback.print_exc()
        sys.exit(1)
    sys.exit()


if __name__ == "__main__":
    for path in map(pathlib.Path, sys.argv[2:]):
        printed = path.with_suffix(".printed")
        if run(path, folder=sys.argv[1], output=printed) != 0:
            printed.unlink()

"""``python -m flaunay``: the command, which is installed with the package, in the place of this process."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, files


def _command() -> str:
    """The path of the command, as the installation lists it."""
    name = "flaunay.exe" if sys.platform == "win32" else "flaunay"
    # With pip's option --target, it is here, and the list is wrong.
    paths = [os.path.join(os.path.dirname(os.path.dirname(__file__)), "bin", name)]
    with contextlib.suppress(PackageNotFoundError):
        paths += [
            os.path.normpath(file.locate())
            for file in files("flaunay") or []
            if file.name == name
        ]
    for path in paths:
        if os.path.isfile(path):
            return path
    sys.exit("flaunay: this installation of the Python package has no command; pip installs it")


def _main() -> None:
    arguments = [_command(), *sys.argv[1:]]
    if sys.platform == "win32":
        # The command decides what Ctrl-C does.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        sys.exit(subprocess.call(arguments))
    os.execv(arguments[0], arguments)


if __name__ == "__main__":
    _main()

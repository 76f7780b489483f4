"""Finds and loads the library, and turns its errors into exceptions; its declarations are in _declarations.py."""

from __future__ import annotations

import ctypes
import os
import sys
from typing import Any, NoReturn, Optional

from flaunay._declarations import FUNCTIONS, STATUS
from flaunay._errors import DeviceError, Error, InputError, InternalError, UsageError

_CLASSES: dict[int, type[Error]] = {
    STATUS["error_internal"]: InternalError,
    STATUS["error_usage"]: UsageError,
    STATUS["error_input"]: InputError,
    STATUS["error_device"]: DeviceError,
}


def _load() -> ctypes.CDLL:
    suffix = {"darwin": "dylib", "win32": "dll"}.get(sys.platform, "so")
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), f"libflaunay.{suffix}")
    try:
        library = ctypes.CDLL(path)
    except OSError as error:
        raise ImportError(
            f"flaunay's library cannot be loaded: {error}; install the package with pip", path=path
        ) from error
    for name, (result, arguments) in FUNCTIONS.items():
        function = library[f"flaunay_{name}"]
        function.restype, function.argtypes = result, arguments
        setattr(library, name, function)
    return library


# Its functions have the names above. The interpreter's lock is released while one is at work.
library = _load()


def text_of(value: Optional[bytes]) -> str:
    return "" if value is None else value.decode("utf-8", "replace")


def error_of(status: int) -> Exception:
    """The exception for a call that failed, with the message of this thread's last error."""
    message = text_of(library.last_error())
    if status == STATUS["error_memory"]:
        return MemoryError(message)
    kind = _CLASSES.get(status, InternalError)
    return kind(message, library.last_error_code(), text_of(library.last_error_call()))


def check(status: int) -> None:
    """Raises the exception of a status that is not success."""
    if status != STATUS["success"]:
        raise error_of(status)


class Handle:
    """A handle of the library, destroyed when nothing refers to it any more."""

    # Kept here because modules are emptied before the last handles are destroyed.
    _destroy: Any
    # Nothing, in an object that was never made.
    pointer: ctypes.c_void_p = ctypes.c_void_p()

    def __init__(self) -> None:
        self.pointer = ctypes.c_void_p()

    @property
    def _as_parameter_(self) -> ctypes.c_void_p:
        """What functions of the library take for it."""
        return self.pointer

    @property
    def place(self) -> Any:
        """Where a function writes the new handle."""
        return ctypes.byref(self.pointer)

    def __reduce__(self) -> NoReturn:
        raise TypeError(
            f"{type(self).__name__} cannot be copied or pickled: what the library has made belongs to its process"
        )

    def _release(self) -> None:
        self._destroy(self.pointer)

    def __del__(self) -> None:
        if self.pointer:
            self._release()


class DeviceHandle(Handle):
    """A handle that may hold what is on a device, which a forked child must not release."""

    _process_id = staticmethod(os.getpid)

    def __init__(self) -> None:
        super().__init__()
        self._process = os.getpid()

    def __del__(self) -> None:
        if self.pointer and self._process == self._process_id():
            self._release()

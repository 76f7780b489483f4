"""The exceptions of flaunay."""

from __future__ import annotations


class Error(RuntimeError):
    """What all exceptions of flaunay have in common.

    Attributes
    ----------
    code : int
        What the OpenCL call returned, such as -5 for ``CL_OUT_OF_RESOURCES``; 0 if none failed.
    call : str
        The OpenCL call that failed, such as ``"clCreateBuffer"``; empty if none did.
    """

    def __init__(self, message: str, code: int = 0, call: str = "") -> None:
        super().__init__(message, code, call)
        self.code = code
        self.call = call

    def __str__(self) -> str:
        return str(self.args[0])


class UsageError(Error, ValueError):
    """A request that makes no sense: a wrong shape, an unknown mode, offsets that decrease."""


class InputError(Error, ValueError):
    """Bad points: not finite, of magnitudes too different to be exact, too many."""


class DeviceError(Error):
    """No such device, one that is too small or not exact enough, or an OpenCL call that failed."""


class InternalError(Error):
    """A broken invariant of flaunay itself; please report it, as CONTRIBUTING.md says."""

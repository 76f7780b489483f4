"""The triangulators, one for each device, kept from call to call."""

from __future__ import annotations

import logging
import os
import sys
import threading
from collections import OrderedDict
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

from flaunay import _calls, _drivers
from flaunay._errors import DeviceError

if TYPE_CHECKING:
    import pyopencl

# Contexts of the caller whose triangulators are kept: enough for a machine's devices, few enough
# that contexts made again and again do not pile up.
_MOST_CONTEXTS = 8

_log = logging.getLogger("flaunay")

# The name of the host itself, which needs no OpenCL.
_HOST = "host"

_lock = threading.Lock()
# Triangulators by name, and whether they call functions of the caller.
_by_name: dict[tuple[str, bool], _calls.Triangulator] = {}
_by_handles: OrderedDict[tuple[int, int], _calls.Triangulator] = OrderedDict()
_inherited: list[Any] = []
_used = False
_forked = False
# Quicker to read than to ask for.
process_id = os.getpid()


def _after_fork() -> None:
    global _forked, _lock, process_id
    process_id = os.getpid()
    _lock = threading.Lock()
    _forked = _used
    # A thread that is not here any more may have been at work in one of these.
    keep((_by_name.copy(), _by_handles.copy()))
    _by_name.clear()
    _by_handles.clear()


if sys.platform != "win32":
    os.register_at_fork(after_in_child=_after_fork)


def _name_of(device: Optional[str]) -> str:
    """The device that calls on host memory use; empty if flaunay may choose."""
    if device is not None and not isinstance(device, str):
        raise TypeError(f"device must be a string or None, not {type(device).__name__}")
    return device or os.environ.get("FLAUNAY_DEVICE", "")


def check_process() -> None:
    """DeviceError in a child of a process that used OpenCL, where its calls would never return."""
    global _used
    if _forked:
        raise DeviceError(
            "OpenCL was in use when this process was forked, and does not survive that: "
            "start it by multiprocessing's 'spawn' or 'forkserver', or name no device"
        )
    _used = True
    _drivers.add_drivers()


def of_device(device: Optional[str], calls_back: bool = False) -> _calls.Triangulator:
    """The triangulator of a device; in a forked child the host's, if flaunay may choose.

    calls_back: whether it is to call functions of the caller. It is another one then, so that these can use this one.
    """
    name = _name_of(device)
    if _forked and not name:
        name = _HOST
    if name != _HOST:
        check_process()
    dropped: list[_calls.Triangulator] = []
    with _lock:
        found = _by_name.get((name, calls_back))
        if found is None:
            if name not in ("", _HOST):
                _log.info(
                    "opening %s: kernels that it has not compiled before take seconds, once", name
                )
            # The environment is left to the triangulator, which names it in its errors.
            found = _calls.Triangulator.of_name(_HOST if name == _HOST else device or "")
            # A device has more than one name; what it holds, it should hold once.
            for (other_name, other_calls_back), other in _by_name.items():
                if other_calls_back != calls_back or {name, other_name} & {"", _HOST}:
                    continue  # another one, not a device, or not yet
                if other.device == found.device:
                    dropped.append(found)
                    found = other
                    break
            _by_name[name, calls_back] = found
        return found


def names_for_chunks(devices: Union[None, str, Sequence[str]]) -> list[str]:
    """The devices of a triangulation in chunks, which opens its own; none if flaunay may choose."""
    given = [devices] if devices is None or isinstance(devices, str) else list(devices)
    names = [_name_of(device) for device in given]
    if _forked and not any(names):
        return [_HOST]
    if set(names) != {_HOST}:
        check_process()
    # The environment is left to the library, which names it in its errors.
    return names if devices else []


def keep(inherited: Any) -> None:
    """Keeps what a forked process got from its parent from being released."""
    _inherited.append(inherited)


def of_queue(queue: pyopencl.CommandQueue) -> _calls.Triangulator:
    """The triangulator in a queue's context."""
    check_process()
    handles = (queue.context.int_ptr, queue.device.int_ptr)
    # Its end waits for queues of the caller, so that it must not come under the lock.
    dropped: list[_calls.Triangulator] = []
    with _lock:
        found = _by_handles.get(handles)
        if found is None:
            found = _calls.Triangulator.of_handles(*handles)
            _by_handles[handles] = found
            if len(_by_handles) > _MOST_CONTEXTS:
                dropped.append(_by_handles.popitem(last=False)[1])
        _by_handles.move_to_end(handles)
        return found


def devices() -> list[dict[str, Any]]:
    """Every OpenCL device, in the order in which ``"#k"`` names them.

    Returns
    -------
    list of dict
        Of each its ``name``, ``platform``, ``vendor``, ``driver``, ``version``, ``type`` (``"CPU"``,
        ``"GPU"``, ``"accelerator"``), ``compute_units``, ``clock_mhz``, ``memory_bytes``,
        ``available_bytes`` (what can be used of it now), ``largest_buffer_bytes``,
        ``local_memory_bytes``, ``work_group_size``, ``fp64`` and ``fixed_point``: whether it has double
        precision, and whether it computes in fixed point because it lacks that.

    Raises
    ------
    DeviceError
        If there is no OpenCL platform.

    Examples
    --------
    >>> import flaunay
    >>> {"name", "type", "fp64"} <= flaunay.devices()[0].keys()
    True
    """
    check_process()
    return _calls.devices()

from collections.abc import Callable
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from flaunay._arrays import FloatArray

_Indices = npt.NDArray[np.int32]
_Offsets = npt.NDArray[np.int64]

__version__: str

def devices() -> list[dict[str, Any]]: ...
def modes() -> list[dict[str, Any]]: ...
def triangulate_without_device(
    points: npt.NDArray[np.float64],
    segments: Optional[_Offsets],
    mode: str,
    wanted: set[str],
) -> dict[str, Any]: ...
def vertex_neighbors(triangles: _Indices, hull: _Indices, n: int) -> tuple[_Indices, _Indices]: ...
def triangulate_chunks(
    points: FloatArray,
    wanted: dict[str, Optional[bytes]],
    wide: bool,
    memory: int,
    scratch: bytes,
    devices: list[str],
    chunk_points: int,
    progress: Optional[Callable[[str, int, float], object]],
) -> tuple[dict[str, Any], dict[str, Any]]: ...
def first_triangles(triangles: _Indices, n: int) -> _Indices: ...

class Triangulator:
    def __init__(self, device: str) -> None: ...
    @staticmethod
    def from_handles(context: int, device: int) -> Triangulator: ...
    @property
    def context(self) -> int: ...
    @property
    def device(self) -> int: ...
    @property
    def queue(self) -> int: ...
    def capacity(self) -> int: ...
    def triangulate(
        self,
        points: FloatArray,
        segments: Optional[_Offsets],
        mode: str,
        wanted: set[str],
    ) -> dict[str, Any]: ...

class DevicePoints:
    def __init__(
        self,
        memory: int,
        count: int,
        single: bool,
        first: int,
        segments: Optional[_Offsets] = ...,
        device_segments: int = ...,
        sets: int = ...,
    ) -> None: ...

class DeviceResult:
    def arrays(self) -> dict[str, Optional[tuple[int, tuple[int, ...]]]]: ...
    @property
    def triangle_offsets(self) -> _Offsets: ...
    @property
    def hull_offsets(self) -> _Offsets: ...
    @property
    def statistics(self) -> dict[str, Any]: ...

def triangulate_device(
    triangulator: Triangulator,
    points: DevicePoints,
    wanted: set[str],
    queue: int,
    wait_for: list[int],
) -> tuple[DeviceResult, int]: ...
def voronoi(
    triangulator: Triangulator,
    points: npt.NDArray[np.float64],
    triangles: _Indices,
    neighbors: _Indices,
    hull: _Indices,
    representatives: _Indices,
) -> tuple[npt.NDArray[np.float64], _Indices, _Indices, npt.NDArray[np.uint8]]: ...

class Locator:
    def __init__(
        self,
        triangulator: Triangulator,
        points: npt.NDArray[np.float64],
        triangles: _Indices,
        neighbors: _Indices,
        hull: _Indices,
        representatives: _Indices,
    ) -> None: ...
    def locate(self, queries: npt.NDArray[np.float64]) -> _Indices: ...
    def nearest(self, queries: npt.NDArray[np.float64]) -> _Indices: ...
    def interpolate(
        self, values: npt.NDArray[np.float64], queries: npt.NDArray[np.float64]
    ) -> npt.NDArray[np.float64]: ...

"""What triangulations on a sphere, on a torus and of weighted points have in common."""

from __future__ import annotations

from typing import Any, Callable, ClassVar, Generic, TypeVar

import numpy as np
import numpy.typing as npt

from flaunay import _calls, _triangulators
from flaunay._arrays import ArrayLike, as_floats, summary
from flaunay._errors import UsageError
from flaunay._queries import Kept

Doubles = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int32]
Locator = TypeVar("Locator", bound=_calls.SurfaceLocator)


class OfPoints:
    """A result that is a function of what was given: the arguments of its class, the device last."""

    points: Doubles
    simplices: Indices
    _given: tuple[Any, ...]

    def __repr__(self) -> str:
        return summary(self, points=self.npoints, triangles=self.nsimplex)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), self._given

    @property
    def _triangulator(self) -> _calls.Triangulator:
        return _triangulators.of_device(self._given[-1])

    @property
    def npoints(self) -> int:
        return len(self.points)

    @property
    def nsimplex(self) -> int:
        return len(self.simplices)


class WithLocator(OfPoints, Generic[Locator]):
    """One that answers queries, by a locator that is made when it is first needed."""

    _Locator: ClassVar[Callable[..., Any]]
    _handle: Any
    _kept_locator: Kept[Locator]

    @property
    def _locator(self) -> Locator:
        return self._kept_locator.get(self._make_locator)

    def _make_locator(self) -> Locator:
        locator: Locator = self._Locator(self._triangulator, self._handle)
        return locator

    def _find(
        self, queries: Doubles, search: Callable[[_calls.SurfaceLocator, Doubles], Indices]
    ) -> Indices:
        """What a method of the locator finds. Queries are checked before there is one."""
        found = search(self._locator, queries.reshape(-1, queries.shape[-1]))
        return found.reshape(queries.shape[:-1])

    def _interpolate(self, values: ArrayLike, queries: Doubles) -> Doubles:
        numbers = np.asarray(as_floats(values, "values"), np.float64)
        if numbers.ndim == 0 or len(numbers) != self.npoints:
            raise UsageError(
                f"values must have one row per point, {self.npoints}, not the shape {numbers.shape}"
            )
        rows = numbers.reshape(self.npoints, -1) if self.npoints else numbers.reshape(0, 1)
        found = self._locator.interpolate(rows, queries.reshape(-1, queries.shape[-1]))
        return found.reshape(queries.shape[:-1] + numbers.shape[1:])

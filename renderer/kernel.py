"""The decorator of every numeric kernel.

Serial, without the GIL: tiles run on a thread pool. No fastmath, which takes NaN for 0. Divisions by zero give
infinities as numpy's do; a kernel that can meet one says what it does with it. NUMBA_DISABLE_JIT=1 runs them all as
plain Python.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numba

F = TypeVar("F", bound=Callable[..., object])


def kernel(function: F) -> F:
    """Compile `function` on its first call, or load it from the cache."""
    return numba.njit(cache=True, nogil=True, error_model="numpy")(function)  # type: ignore[no-any-return]


def leaf(function: F) -> F:
    """A small function that only kernels call: the compiler sets it in where it is called."""
    return numba.njit(cache=False, nogil=True, error_model="numpy", inline="never")(function)  # type: ignore[no-any-return]

"""The decorators of numeric kernels, and what keeps them fast.

Serial, without the GIL: tiles run on a thread pool. No fastmath, which takes NaN for 0. Divisions by zero give
infinities as numpy's do; a kernel that can meet one says what it does with it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba
import numpy as np
from numba.core import types
from numba.extending import intrinsic

F = TypeVar("F", bound=Callable[..., object])
N = TypeVar("N", int, bool)


def kernel(function: F) -> F:
    """What Python calls: compiled on its first call, or loaded from the cache."""
    return numba.njit(cache=True, nogil=True, error_model="numpy")(function)  # type: ignore[no-any-return]


def leaf(function: F) -> F:
    """A small function that only kernels call: set in where it is called."""
    return numba.njit(cache=False, nogil=True, error_model="numpy", forceinline=True)(function)  # type: ignore[no-any-return]


def callee(function: F) -> F:
    """A function that only kernels call, called: for what is rarely needed, and long. Its arrays must be borrowed."""
    return numba.njit(cache=False, nogil=True, error_model="numpy")(function)  # type: ignore[no-any-return]


def fixed(value: N) -> N:
    """A constant to hand to a function in a kernel. For a plain one numba would compile that function once more."""
    return cast(N, np.asarray(value)[()])


@intrinsic  # type: ignore[untyped-decorator]
def borrow(_: Any, table: Any) -> Any:
    """The same array, or tuple of arrays, without a count of its references. For kernels.

    Handing an array to a function counts a reference up and down again, atomically, which threads that share the
    array pay for: the kernels ran ten times slower with it. The caller keeps the array alive.
    """

    def uncounted(context: Any, builder: Any, kind: Any, value: Any) -> Any:
        if isinstance(kind, types.Array):
            array = context.make_array(kind)(context, builder, value)
            array.meminfo = array.meminfo.type(None)
            array.parent = array.parent.type(None)
            return array._getvalue()
        if isinstance(kind, types.BaseTuple):  # type: ignore[attr-defined]
            items = [uncounted(context, builder, k, builder.extract_value(value, i)) for i, k in enumerate(kind)]
            return context.make_tuple(builder, kind, items)
        return value

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return uncounted(context, builder, signature.args[0], arguments[0])

    return table(table), generate


@intrinsic  # type: ignore[untyped-decorator]
def keep(_: Any, table: Any) -> Any:
    """Keeps what a kernel has allocated, and then borrowed, alive until here."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return context.get_dummy_value()

    return types.none(table), generate

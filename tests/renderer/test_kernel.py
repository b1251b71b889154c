"""The decorators of kernels."""

from __future__ import annotations

import sys
import weakref
from typing import Any, cast

import numba
import numpy as np
import pytest
from numpy.typing import NDArray

from renderer.geometry.share import share
from renderer.kernel import kernel, leaf
from renderer.tables import Floats

from .parts import alone


def test_a_part_is_no_function_of_python() -> None:
    """It has no machine code of its own, says so the first time and the second, and runs in a kernel."""
    for _ in range(2):
        with pytest.raises(TypeError):
            share(1.0, 0.0, -0.25)
    assert alone(share)(1.0, 0.0, -0.25) == 0.75
    with pytest.raises(TypeError):
        share(1.0, 0.0, -0.25)


ROW = np.dtype([("key", "i8"), ("place", "f8", (3,))])


@leaf
def middle(row: Any) -> float:
    place = row.place
    return float(place[1])


@kernel
def middles(rows: NDArray[np.void]) -> Floats:
    found = np.empty(len(rows))
    for i in range(len(rows)):
        found[i] = middle(rows[i])
    return found


def test_nothing_is_counted_where_there_is_nothing_to_count() -> None:
    """numba counts references to an array in a record, which has none, by calls that keep numbers from registers."""
    told = cast(Any, middles)
    compiled = numba.njit(nogil=True, error_model="numpy", pipeline_class=told._compiler.pipeline_class)(told.py_func)
    compiled(np.zeros(3, ROW))
    body = compiled.inspect_llvm(compiled.signatures[0]).split("define ptr @_ZN7cpython")[0]
    assert "getelementptr" in body
    assert "@NRT_incref" not in body
    assert "@NRT_decref" not in body


def test_what_a_kernel_returns_is_freed_with_its_last_reference() -> None:
    rows = np.zeros(3, ROW)
    rows["place"] = np.arange(9.0).reshape(3, 3)
    found = middles(rows)
    assert found.tolist() == [1.0, 4.0, 7.0]
    assert sys.getrefcount(rows) == 2
    gone = weakref.ref(found)
    del found
    assert gone() is None

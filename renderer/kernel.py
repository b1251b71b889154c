"""The decorators of numeric kernels, and what keeps them fast.

Serial, without the GIL: tiles run on a thread pool. No fastmath, which takes NaN for 0. Divisions by zero give
infinities as numpy's do; a kernel that can meet one says what it does with it.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba
import numpy as np
from numba.core import types
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import register_pass
from numba.core.typed_passes import NativeLowering
from numba.extending import intrinsic

F = TypeVar("F", bound=Callable[..., object])
N = TypeVar("N", int, bool)


def kernel(function: F) -> F:
    """What Python calls: compiled on its first call, or loaded from the cache."""
    return numba.njit(cache=True, nogil=True, error_model="numpy")(function)  # type: ignore[no-any-return]


def leaf(function: F) -> F:
    """A function that only kernels call, small or often needed: set in where it is called."""
    return _part(function, forceinline=True)


def callee(function: F) -> F:
    """A function that only kernels call, called: for what is rarely needed, and long. Its arrays must be borrowed."""
    return _part(function, forceinline=False)  # said, as numba else hands on what a leaf that calls it has


class _PartLibrary(JITCodeLibrary):  # type: ignore[misc]
    """What a part of kernels is translated to: LLVM's code, for kernels to link.

    numba optimizes every function it meets, with all it calls, and makes machine code of it, kernels and their parts
    alike. Of parts that is never run: a kernel optimizes them once more with itself. Leaving it out halves the time
    to compile, and changes nothing of the kernels.
    """

    def _optimize_final_module(self) -> None:
        pass

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """Of what Python runs when it calls a part: it raises TypeError."""
        self._ensure_finalized()
        return cast(int, ctypes.cast(ctypes.pythonapi.PyErr_BadArgument, ctypes.c_void_p).value)

    @property
    def codegen(self) -> _PartLibrary:
        """What numba tells the place of a function's constants. Here it has none."""
        return self

    def set_env(self, name: str, environment: object) -> None:
        """Nothing: see above."""


@register_pass(mutates_CFG=True, analysis_only=False)
class _PartLowering(NativeLowering):  # type: ignore[misc]
    _name = "part_lowering"

    def run_pass(self, state: Any) -> bool:
        state.library = _PartLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        return cast(bool, super().run_pass(state))


class _PartCompiler(CompilerBase):  # type: ignore[misc]
    def define_pipelines(self) -> list[Any]:
        passes = DefaultPassBuilder.define_nopython_pipeline(self.state)
        passes.passes = [(_PartLowering if p is NativeLowering else p, why) for p, why in passes.passes]
        passes.finalize()
        return [passes]


def _part(function: F, *, forceinline: bool) -> F:
    return numba.njit(  # type: ignore[no-any-return]
        cache=False, nogil=True, error_model="numpy", forceinline=forceinline, no_cpython_wrapper=True,
        no_cfunc_wrapper=True, pipeline_class=_PartCompiler,
    )(function)  # fmt: skip


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

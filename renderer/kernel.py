"""The decorators of numeric kernels, and what keeps them fast.

Serial, without the GIL: tiles run on a thread pool. No fastmath, which takes NaN for 0. Divisions by zero give
infinities as numpy's do; a kernel that can meet one says what it does with it.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any, TypeVar, cast

import llvmlite.binding
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
    return numba.njit(  # type: ignore[no-any-return]
        cache=True, nogil=True, error_model="numpy", pipeline_class=_KernelCompiler
    )(function)


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


_COUNTS = """
declare void @NRT_MemInfo_call_dtor(ptr)

define linkonce_odr void @NRT_incref(ptr %counted) {
  %none = icmp eq ptr %counted, null
  br i1 %none, label %done, label %count
count:
  %before = atomicrmw add ptr %counted, i64 1 monotonic
  br label %done
done:
  ret void
}

define linkonce_odr void @NRT_decref(ptr %counted) {
  %none = icmp eq ptr %counted, null
  br i1 %none, label %done, label %count
count:
  %before = atomicrmw sub ptr %counted, i64 1 acq_rel
  %last = icmp eq i64 %before, 1
  br i1 %last, label %free, label %done
free:
  call void @NRT_MemInfo_call_dtor(ptr %counted)
  br label %done
done:
  ret void
}
"""


class _KernelLibrary(JITCodeLibrary):  # type: ignore[misc]
    """What a kernel is translated to: machine code in which nothing is left of counts of what is not counted.

    numba calls a function to count a reference up or down, also where it knows that there is nothing to count, as of
    fields of records and of what is borrowed. Each call costs little, but none of a kernel's numbers stays in a
    register over it. Here the counting is set in, and goes where there is nothing to count. And what only the kernel
    calls is known to be its own: of the hundreds of numbers in its tables, functions are handed those they use.
    """

    def __init__(self, codegen: Any, name: str) -> None:
        super().__init__(codegen, name)
        known = str(codegen._create_empty_module(name)) + _COUNTS  # the first definition is what counts
        self._final_module = llvmlite.binding.parse_assembly(known)

    def _optimize_final_module(self) -> None:
        for function in self._final_module.functions:
            if function.linkage == llvmlite.binding.Linkage.linkonce_odr:
                function.linkage = llvmlite.binding.Linkage.internal
        super()._optimize_final_module()


@register_pass(mutates_CFG=True, analysis_only=False)
class _PartLowering(NativeLowering):  # type: ignore[misc]
    _name = "part_lowering"

    def run_pass(self, state: Any) -> bool:
        state.library = _PartLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        return cast(bool, super().run_pass(state))


@register_pass(mutates_CFG=True, analysis_only=False)
class _KernelLowering(NativeLowering):  # type: ignore[misc]
    _name = "kernel_lowering"

    def run_pass(self, state: Any) -> bool:
        state.library = _KernelLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return cast(bool, super().run_pass(state))


class _PartCompiler(CompilerBase):  # type: ignore[misc]
    _lowering = _PartLowering

    def define_pipelines(self) -> list[Any]:
        passes = DefaultPassBuilder.define_nopython_pipeline(self.state)
        passes.passes = [(self._lowering if p is NativeLowering else p, why) for p, why in passes.passes]
        passes.finalize()
        return [passes]


class _KernelCompiler(_PartCompiler):
    _lowering = _KernelLowering


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

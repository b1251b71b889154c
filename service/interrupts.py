"""Work that Ctrl-C stops at once, whatever it is doing."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from types import FrameType
from typing import Generic, TypeVar

T = TypeVar("T")

_GRACE = 2.0  # seconds that the work has to notice
_POLL = 0.05  # the main thread must wake up to handle signals


class Stopped(Exception):
    """A signal came; `number` says which."""

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.number = number


class Interruptible(Generic[T]):
    """Runs `work` on a thread of its own and waits for it on the main thread, which handles the signals.

    The work is handed a function that says whether to stop. Work that does not look at it, as in the middle of
    compiling a kernel, is left behind: the caller then ends the process.
    """

    def __init__(self, work: Callable[[Callable[[], bool]], T]) -> None:
        self._work = work
        self._stop = threading.Event()
        self._signal = 0
        self._result: T | None = None
        self._error: BaseException | None = None

    def run(self) -> T:
        """What the work gives, or what it raises, or Stopped."""
        thread = threading.Thread(target=self._body, daemon=True)
        before = {number: signal.signal(number, self._handle) for number in (signal.SIGINT, signal.SIGTERM)}
        try:
            thread.start()
            while thread.is_alive() and not self._stop.is_set():
                thread.join(_POLL)
            if self._stop.is_set():
                thread.join(_GRACE)
                raise Stopped(self._signal)
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)
        if self._error is not None:
            raise self._error
        return self._result  # type: ignore[return-value]

    def _handle(self, number: int, _: FrameType | None) -> None:
        self._signal = number
        self._stop.set()

    def _body(self) -> None:
        try:
            self._result = self._work(self._stop.is_set)
        except BaseException as error:
            self._error = error

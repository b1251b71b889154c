"""The threads that render: few, with a bounded queue before them."""

from __future__ import annotations

import asyncio
import contextlib
import os
import sys
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from fastapi import Request

from renderer.errors import Cancelled
from service.problems import BUSY, TOO_LONG, ProblemError

T = TypeVar("T")

_NICENESS = 5  # of the render threads, and of those they start
_POLL = 0.1  # seconds between looks for a client that has gone


class ClientGone(Exception):
    """Nobody waits for the answer any more."""


class Renders:
    """A process-wide pool. Kernels run without the GIL, so the event loop goes on answering meanwhile."""

    def __init__(self, workers: int, queue: int, time_limit: float, prepare: Callable[[], object]) -> None:
        """`prepare` loads the kernels, and returns at once when they are there. No work's time begins before."""
        self._places = workers + queue
        self._time_limit = time_limit
        self._taken = 0
        self._lock = threading.Lock()
        self._stops: set[threading.Event] = set()
        self._prepare = prepare
        self._preparing = threading.Lock()
        self._pool = ThreadPoolExecutor(workers, "render", initializer=_step_back)

    @property
    def taken(self) -> int:
        """How many run or wait."""
        return self._taken

    def warm_up(self) -> None:
        """Prepare now, in the background."""
        self._pool.submit(self._prepared)

    async def run(self, work: Callable[[Callable[[], bool]], T], request: Request) -> T:
        """What `work` gives. It is handed a function that says whether to stop: the client has gone, or the time is
        over; it then raises Cancelled."""
        with self._lock:
            if self._taken >= self._places:
                raise ProblemError(
                    503, "Too many renders at once. Try again soon.", kind=BUSY, headers={"Retry-After": "2"}
                )
            self._taken += 1
        stop = threading.Event()
        deadline = float("inf")

        def stopped() -> bool:
            return stop.is_set() or time.monotonic() > deadline

        def task() -> T:
            nonlocal deadline
            if stop.is_set():
                raise Cancelled
            self._prepared()
            deadline = time.monotonic() + self._time_limit
            return work(stopped)

        future = self._pool.submit(task)
        future.add_done_callback(lambda _: self._leave(stop))
        self._stops.add(stop)
        waiting = asyncio.wrap_future(future)
        try:
            while True:
                done, _ = await asyncio.wait({waiting}, timeout=_POLL)
                if done:
                    return waiting.result()
                if await request.is_disconnected():
                    raise ClientGone
        except Cancelled:
            raise ProblemError(
                503,
                f"The render took longer than {self._time_limit:g} seconds. Ask for fewer pixels or samples.",
                kind=TOO_LONG,
            ) from None
        finally:
            stop.set()
            future.cancel()
            waiting.cancel()

    def close(self) -> None:
        """Stop what runs and forget what waits."""
        for stop in list(self._stops):
            stop.set()
        self._pool.shutdown(wait=False, cancel_futures=True)

    def _prepared(self) -> None:
        with self._preparing:
            self._prepare()

    def _leave(self, stop: threading.Event) -> None:
        with self._lock:
            self._taken -= 1
            self._stops.discard(stop)


def _step_back() -> None:
    """Let the event loop's thread go first."""
    if sys.platform == "linux":
        with contextlib.suppress(OSError):
            os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), _NICENESS)

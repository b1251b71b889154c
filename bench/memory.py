"""Memory of compiled patterns."""

from __future__ import annotations

from typing import Any

from bench.report import Line, at_most
from bench.scenes import load
from renderer.compile import PatternCache, table_bytes

KB = 1024


def measure() -> tuple[list[Line], dict[str, Any]]:
    """The pattern of figure 14 and the first record of figure 19, which has 500 grooves."""
    cache = PatternCache()
    sizes = {
        name: table_bytes(cache.pattern(load(scene).patterns[name]))
        for scene, name in (("parallel", "furrows"), ("vinyl", "symmetric"), ("vinyl", "random"))
    }
    return [
        at_most("figure 14: the compiled pattern", sizes["furrows"] / KB, 32, "KB"),
        at_most("figure 19: a record of 500 circles", sizes["symmetric"] / KB, 200, "KB"),
        at_most("figure 19: a record of 500 circles, three profiles", sizes["random"] / KB, 200, "KB"),
    ], sizes

"""A scene becomes tables: the one door where pydantic's models end."""

from renderer.compile.patterns import Compiled, PatternCache, internal, table_bytes
from renderer.compile.scene import CompiledScene, compile_scene

__all__ = ["Compiled", "CompiledScene", "PatternCache", "compile_scene", "internal", "table_bytes"]

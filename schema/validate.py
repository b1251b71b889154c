"""The validation tool: all problems of a scene at once, each with its place."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from pydantic import ValidationError

from .approximations import left_out, tight_paths
from .base import ErrorBudget, TooManyErrors
from .errors import Problem
from .meaning import camera_inside, unresolved_names
from .parts import parts_of_data, parts_of_scene
from .report import problems_of
from .scene import Scene
from .text import data_of_text

MAX_ERRORS = 20_000
MAX_PROBLEMS = 1000


@dataclass(frozen=True, slots=True)
class Report:
    """A scene, or else the problems that it has; with warnings either way."""

    scene: Scene | None
    problems: list[Problem]
    warnings: list[Problem]


def check(data: object) -> Report:
    """Validates parsed JSON."""
    problems: list[Problem] = []
    scene: Scene | None = None
    try:
        scene = Scene.model_validate(data, context=ErrorBudget(MAX_ERRORS))
    except TooManyErrors:
        return Report(None, [Problem("", f"a scene with at most {MAX_ERRORS} problems", "more")], [])
    except ValidationError as error:
        problems += problems_of(error)
    parts = parts_of_data(data) if scene is None else parts_of_scene(scene)
    problems += unresolved_names(data)
    problems += camera_inside(parts)
    warnings = list(tight_paths(parts))
    if scene is not None and not problems:
        warnings += left_out(scene)
    return Report(None if problems else scene, _listed(problems), _listed(warnings))


def check_text(text: str | bytes) -> Report:
    """Validates JSON text."""
    data, problems = data_of_text(text)
    if problems:
        return Report(None, _listed(problems), [])
    return check(data)


def _listed(problems: Iterable[Problem]) -> list[Problem]:
    """Each once, and not more than anyone reads."""
    unique: list[Any] = list(dict.fromkeys(problems))
    if len(unique) <= MAX_PROBLEMS:
        return unique
    rest = Problem("", f"at most {MAX_PROBLEMS} problems to list", f"{len(unique)}", unique[0].severity)
    return [*unique[:MAX_PROBLEMS], rest]

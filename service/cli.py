"""The command line.

Everything heavy is imported by the command that needs it: `intaglio validate` starts without numpy and numba.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn, TypeVar

import typer

from service import COMPILING, outputs
from service.interrupts import Interruptible, Stopped

if TYPE_CHECKING:
    from renderer.pipeline import Picture
    from schema import Problem, Report, Scene
    from service.chart.run import Plan

T = TypeVar("T")
WRONG, UNREADABLE, STOPPED = 1, 2, 130  # exit codes; 0: all is well
SCENE_LIMIT = 64 << 20  # bytes of a scene file
FILE_LIMIT = 1 << 30  # bytes of a mesh or an envmap
AOVS = ("method", "error", "cost")
SOLIDS, MAP_FILES = (".glb", ".stl", ".ply", ".obj"), (".png", ".exr")
MAPS = ("height", "normal", "anisotropy")

app = typer.Typer(
    name="intaglio",
    help="Renders grooved surfaces.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
SceneFile = Annotated[str, typer.Argument(metavar="SCENE", help="A scene file, or - for the standard input.")]


@app.command()
def render(
    scene: SceneFile,
    out: Annotated[Path, typer.Option("-o", "--out", metavar="OUT", help="The picture: .png, .exr or .npy.")],
    method: Annotated[str | None, typer.Option(metavar="M", help="Instead of the scene's.")] = None,
    samples: Annotated[
        int | None,
        typer.Option(metavar="N", min=1, max=65536, help="Of lines, csg, geometry, relief; instead of the scene's."),
    ] = None,
    texels: Annotated[
        int | None, typer.Option(metavar="N", min=16, max=8192, help="Method relief's, instead of the scene's.")
    ] = None,
    threads: Annotated[int | None, typer.Option(metavar="N", min=1, max=1024, help="All cores otherwise.")] = None,
    resolution: Annotated[str | None, typer.Option(metavar="WxH", help="Instead of the camera's.")] = None,
    aov: Annotated[
        list[str] | None, typer.Option(metavar="NAME=OUT", help=f"A further picture: {', '.join(AOVS)}.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print timings and statistics as one object.")] = False,
) -> None:
    """Render a scene file into a picture."""
    _known_method(method)
    size = _resolution(resolution)
    wanted = _aovs(aov or [])
    for path in (out, *(path for _, path in wanted)):
        problem = outputs.fault(path)
        if problem:
            _fail(UNREADABLE, problem)
    report, folder = _read(scene)
    checked = _valid(report)
    _files_exist(checked, folder)

    def work(stopped: Callable[[], bool]) -> tuple[Picture, list[tuple[Path, bytes]]]:
        from renderer import film, pipeline

        if not pipeline.kernels_compiled():
            _say(COMPILING)
        with _progress() as progress:
            picture = pipeline.render(
                checked,
                method=method,
                samples=samples,
                texels=texels,
                threads=threads,
                resolution=size,
                progress=progress,
                cancelled=stopped,
                meshes=lambda name: (folder / name).read_bytes(),
            )
        files = [(out, film.encode(picture.radiance, out.suffix.lower(), checked.render.exposure))]
        for name, path in wanted:
            files.append((path, film.encode_aov(name, picture.aovs[name], path.suffix.lower())))
        return picture, files

    picture, files = _finish(work)
    try:
        for path, data in files:
            outputs.write(path, data)
    except OSError as error:
        _fail(WRONG, f"{out}: cannot be written: {error.strerror}")
    if as_json:
        _print_json(_statistics(picture, out, wanted, report))


@app.command()
def chart(
    scene: SceneFile,
    out: Annotated[Path, typer.Option("-o", "--out", metavar="DIR", help="Made where there is none.")],
    resolution: Annotated[str | None, typer.Option(metavar="WxH", help="The camera's at a width of 320 else.")] = None,
    methods: Annotated[str | None, typer.Option(metavar="M,M", help="All otherwise.")] = None,
    budget: Annotated[float, typer.Option(metavar="SECONDS", min=1, max=1e6, help="Of rendering.")] = 240.0,
    threads: Annotated[int | None, typer.Option(metavar="N", min=1, max=1024, help="All cores otherwise.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print chart.json.")] = False,
) -> None:
    """Measure speed against accuracy: every method against the converged reference.

    Leaves chart.png, contact.png and chart.json. After Ctrl-C, the same command goes on from there.
    """
    names = None if methods is None else [name for name in methods.split(",") if name]
    for name in names or []:
        _known_method(name, "--methods")
    size = _resolution(resolution)
    problem = outputs.folder_fault(out)
    if problem:
        _fail(UNREADABLE, problem)
    report, folder = _read(scene)
    checked = _valid(report)
    _files_exist(checked, folder)
    title = "standard input" if scene == "-" else Path(scene).name

    def planned() -> Plan:
        from service.chart import make

        read = lambda name: (folder / name).read_bytes()  # noqa: E731
        return make.plan(checked, budget=budget, resolution=size, names=names, threads=threads, meshes=read)

    def work(stopped: Callable[[], bool]) -> None:
        from renderer import pipeline
        from service.chart import make

        if not pipeline.kernels_compiled():
            _say(COMPILING)
        plan = planned()
        with _progress("measuring") as progress:
            state = make.measure(plan, out, stopped, progress, _say)
        make.write(plan, state, out, title)

    def leave() -> None:
        from service.chart import make

        plan = planned()
        state = make.left(plan, out)
        if state is None:
            return _say("stopped: nothing was measured")
        make.write(plan, state, out, title)
        return _say(f"stopped: {out} has what was measured; the same command goes on")

    _finish(work, leave)
    if as_json:
        _print((out / "chart.json").read_text().rstrip())


@app.command()
def export(
    scene: SceneFile,
    out: Annotated[
        Path,
        typer.Option("-o", "--out", metavar="OUT", help="A solid: .glb, .stl, .ply or .obj. A map: .png or .exr."),
    ],
    index: Annotated[
        int | None,
        typer.Option("--object", metavar="N", min=0, help="Which object, from 0; else the only one with a pattern."),
    ] = None,
    kind: Annotated[str | None, typer.Option("--map", metavar="KIND", help=f"One of {', '.join(MAPS)}.")] = None,
    size: Annotated[str | None, typer.Option(metavar="N", help="Texels of a map, N or WxH; 1024.")] = None,
    thickness: Annotated[
        float | None, typer.Option(metavar="T", help="Of a rectangle or an open mesh, world units.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print what was written as one object.")] = False,
) -> None:
    """Write an object's solid as a mesh, or a map of it."""
    if kind is not None and kind not in MAPS:
        _fail(UNREADABLE, f"--map: expected one of {', '.join(MAPS)}, found {kind!r}")
    solid = out.suffix.lower() in SOLIDS
    if not solid and out.suffix.lower() in MAP_FILES and kind is None:
        _fail(UNREADABLE, f"--map: expected one of {', '.join(MAPS)}, as {out.name} is a picture, found none")
    problem = outputs.fault(out, MAP_FILES if kind else (*SOLIDS, *MAP_FILES))
    if problem:
        _fail(UNREADABLE, problem)
    if solid and size is not None:
        _fail(UNREADABLE, "--size: expected a map, as a solid has no texels")
    if not solid and thickness is not None:
        _fail(UNREADABLE, "--thickness: expected a solid, as a map has none")
    report, folder = _read(scene)
    checked = _valid(report)
    _files_exist(checked, folder)
    from service import exports

    try:
        row = exports.chosen(checked, index)
    except ValueError as error:
        _fail(UNREADABLE, f"--object: {error}")
    try:
        texels = exports.SIZE if size is None else exports.size_of_text(size)
    except ValueError as error:
        _fail(UNREADABLE, f"--size: {error}")
    order = exports.Order(kind or exports.SOLID, out.suffix.lower(), row, texels, thickness)

    def work(stopped: Callable[[], bool]) -> tuple[bytes, dict[str, Any]]:
        return exports.make(checked, order, meshes=lambda name: (folder / name).read_bytes(), cancelled=stopped)

    data, told = _finish(work, lambda: _say("stopped: no file was written"))
    try:
        outputs.write(out, data)
    except OSError as error:
        _fail(WRONG, f"{out}: cannot be written: {error.strerror}")
    if as_json:
        _print_json({"out": str(out), **told, "warnings": [_finding(warning) for warning in report.warnings]})


@app.command()
def validate(
    scene: SceneFile,
    as_json: Annotated[bool, typer.Option("--json", help="Print one object.")] = False,
) -> None:
    """Check a scene file: exit code 0 valid, 1 problems, 2 unreadable."""
    report, _ = _read(scene)
    if as_json:
        _print_json(
            {
                "valid": not report.problems,
                "problems": [_finding(p) for p in report.problems],
                "warnings": [_finding(p) for p in report.warnings],
            }
        )
    else:
        for problem in report.problems:
            _print(problem.line())
        _warn(report)
    if report.problems:
        raise typer.Exit(WRONG)


@app.command("schema")
def json_schema() -> None:
    """Print the JSON Schema of scene files."""
    import schema

    _print_json(schema.json_schema())


@app.command()
def serve(
    host: Annotated[str, typer.Option(metavar="H", help="The address to listen on.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(metavar="P", min=0, max=65535, help="0: any free one.")] = 8000,
) -> None:
    """Start the editor and the REST service."""
    from service.server import ServerError, run

    try:
        run(host, port, _say)
    except ServerError as error:
        _fail(WRONG, str(error))


def main() -> None:
    """The console script."""
    try:
        app()
    except BrokenPipeError:  # as in `intaglio schema | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(WRONG)


def _read(name: str) -> tuple[Report, Path]:
    """The report on a scene, and the folder that its file names start from."""
    try:
        if name == "-":
            data = sys.stdin.buffer.read(SCENE_LIMIT + 1)
            folder = Path()
        else:
            folder = Path(name).parent
            with open(name, "rb") as file:
                data = file.read(SCENE_LIMIT + 1)
    except OSError as error:
        _fail(UNREADABLE, f"{name}: cannot be read: {error.strerror or error}")
    except ValueError as error:  # a name with a zero character
        _fail(UNREADABLE, f"{name!r}: cannot be read: {error}")
    except KeyboardInterrupt:
        _fail(STOPPED, "stopped")
    if len(data) > SCENE_LIMIT:
        _fail(UNREADABLE, f"{name}: expected at most {SCENE_LIMIT >> 20} MiB, found more")
    import schema
    from schema.text import data_of_text

    parsed, problems = data_of_text(data)
    if problems and parsed is None:
        _fail(UNREADABLE, *(f"{name}: expected {p.expected}, found {p.found}" for p in problems))
    return (schema.Report(None, problems, []) if problems else schema.check(parsed)), folder


def _valid(report: Report) -> Scene:
    """The scene; all problems and exit code 1 where there is none."""
    _warn(report)
    if report.scene is None or report.problems:
        _fail(WRONG, *(problem.line() for problem in report.problems))
    return report.scene


def _known_method(method: str | None, option: str = "--method") -> None:
    if method is not None:
        from service.overrides import method_fault

        fault = method_fault(method)
        if fault:
            _fail(UNREADABLE, f"{option}: {fault}")


def _files_exist(scene: Scene, folder: Path) -> None:
    """Exit code 1 where a mesh or an envmap is not there."""
    import schema

    problems = []
    for place, name in schema.files(scene):
        path = folder / name
        try:
            with open(path, "rb"):
                size = path.stat().st_size
        except (OSError, ValueError) as error:
            found = f"{path}: {getattr(error, 'strerror', None) or error}"
            problems.append(schema.Problem(place, "a file that can be read", found))
        else:
            if size > FILE_LIMIT:
                problems.append(schema.Problem(place, f"at most {FILE_LIMIT} bytes", f"{path}: {size} bytes"))
    if problems:
        _fail(WRONG, *(problem.line() for problem in problems))


def _nothing() -> None:
    _say("stopped: no picture was written")


def _finish(work: Callable[[Callable[[], bool]], T], leave: Callable[[], None] = _nothing) -> T:
    """What `work` gives. leave: called where it is stopped, before the process ends."""
    from renderer.errors import RenderError

    try:
        return Interruptible(work).run()
    except Stopped as stopped:
        leave()
        sys.stdout.flush()
        sys.stderr.flush()
        # Not sys.exit: it would wait for threads that do not look up.
        os._exit(STOPPED if stopped.number == signal.SIGINT else 128 + stopped.number)
    except RenderError as error:
        _fail(WRONG, *(f"{f.pointer or '(root)'}: expected {f.expected}, found {f.found}" for f in error.faults))
    except MemoryError:
        _fail(WRONG, "there is not enough memory for this picture")
    except OSError as error:
        _fail(WRONG, f"cannot be rendered: {error}")
    except Exception as error:
        if os.environ.get("INTAGLIO_TRACEBACK"):
            raise
        _fail(3, f"a bug: {type(error).__name__}: {error} (INTAGLIO_TRACEBACK=1 shows where)")


def _resolution(text: str | None) -> tuple[int, int] | None:
    if text is None:
        return None
    from service import overrides

    try:
        return overrides.resolution(text)
    except ValueError as error:
        _fail(UNREADABLE, f"--resolution: {error}")


def _aovs(texts: list[str]) -> list[tuple[str, Path]]:
    wanted = []
    for text in texts:
        name, equals, path = text.partition("=")
        if name not in AOVS or not equals or not path:
            _fail(UNREADABLE, f"--aov: expected NAME=OUT with NAME one of {', '.join(AOVS)}, found {text!r}")
        wanted.append((name, Path(path)))
    return wanted


def _statistics(picture: Picture, out: Path, aovs: list[tuple[str, Path]], report: Report) -> dict[str, Any]:
    """What `render --json` prints."""
    height, width = picture.radiance.shape[:2]
    stages = dict(picture.seconds)
    return {
        "out": str(out),
        "aovs": {name: str(path) for name, path in aovs},
        "resolution": [width, height],
        "kernel_seconds": stages.pop("kernels", 0.0),
        "seconds": stages,
        "pattern_bytes": picture.pattern_bytes,
        "shares": picture.shares,
        "warnings": [_finding(warning) for warning in report.warnings],
    }


@contextlib.contextmanager
def _progress(what: str = "rendering") -> Iterator[Callable[[float], None] | None]:
    """A progress bar on the standard error, if that is a terminal."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

    columns = (TextColumn(what), BarColumn(), TaskProgressColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("render", total=1.0)
        yield lambda share: bar.update(task, completed=share)


def _finding(problem: Problem) -> dict[str, str]:
    return {"pointer": problem.pointer, "expected": problem.expected, "found": problem.found}


def _warn(report: Report) -> None:
    for warning in report.warnings:
        _say(f"warning: {warning.line()}")


def _print(line: str) -> None:
    sys.stdout.buffer.write(line.encode("utf-8", "backslashreplace") + b"\n")
    sys.stdout.buffer.flush()


def _print_json(value: object) -> None:
    _print(json.dumps(value, indent=2, ensure_ascii=False))


def _say(line: str) -> None:
    text = line.encode(sys.stderr.encoding or "utf-8", "backslashreplace").decode(sys.stderr.encoding or "utf-8")
    print(text, file=sys.stderr, flush=True)  # noqa: T201


def _fail(code: int, *lines: str) -> NoReturn:
    for line in lines:
        _say(line)
    raise typer.Exit(code)


if __name__ == "__main__":
    main()

"""All measurements in one process run: a table on the terminal, bench/results.json, each run in bench/out/raw.json.

    python -m bench [truth] [papers] [special] [speed] [memory] [startup]
    python -m bench stability

Takes about three quarters of an hour on two cores, nearly all for the references of `papers`, which writes
docs/PAPERS.md, and of `special`, which keeps its own in bench/out. `stability` takes about twenty minutes, is measured
only where it is named, and writes the maps and tables of docs/STABILITY.md.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from bench import memory, papers, speed, startup, truth
from bench.report import Line, table
from bench.special import measure as special
from bench.stability import page
from renderer import pipeline
from service.chart.machine import machine

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "bench" / "results.json"  # of a whole run
OUT = ROOT / "bench" / "out"
PARTS = {
    "truth": truth.measure,
    "papers": papers.measure,
    "special": special.measure,
    "speed": speed.measure,
    "memory": memory.measure,
    "startup": startup.measure,
}
NAMED = {"stability": page.measure}  # measured only where they are named


def main(names: list[str]) -> int:
    """Measure what is named, or all: 1 where something misses its goal."""
    unknown = [name for name in names if name not in PARTS | NAMED]
    if unknown:
        print(f"expected any of {', '.join(PARTS | NAMED)}, found {', '.join(unknown)}", file=sys.stderr)
        return 2
    about = machine()
    print(f"{about['processor']}, {about['cores']} cores; commit {about['commit']}", flush=True)
    pipeline.warm_up()
    lines: list[Line] = []
    details: dict[str, object] = {}
    for name in names or PARTS:
        print(f"measuring {name} ...", flush=True)
        found, detail = (PARTS | NAMED)[name]()
        lines += found
        details[name] = detail
    print(table(lines))
    OUT.mkdir(parents=True, exist_ok=True)
    (OUT / "raw.json").write_text(json.dumps({"machine": about, "details": details}, indent=2) + "\n")
    if not names:
        result = {"command": "python -m bench", "machine": about, "lines": [line._asdict() for line in lines]}
        RESULTS.write_text(json.dumps(result, indent=2) + "\n")
    return int(any(line.met is False for line in lines))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

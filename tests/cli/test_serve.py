"""`intaglio serve`."""

from __future__ import annotations

import os
import re
import signal
import socket
import subprocess
import sys
from pathlib import Path

import httpx

from .conftest import Command

ROOT = Path(__file__).resolve().parents[2]


def test_serves_until_stopped() -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "service.cli", "serve", "--port", "0"],
        stderr=subprocess.PIPE,
        env={**os.environ, "PYTHONPATH": str(ROOT), "INTAGLIO_WARM_UP": "0"},
    )
    try:
        assert process.stderr is not None
        first = process.stderr.readline().decode()
        found = re.fullmatch(r"intaglio: (http://127\.0\.0\.1:\d+/) \(Ctrl-C stops it\)\n", first)
        assert found, first
        transport = httpx.HTTPTransport(retries=5)
        with httpx.Client(transport=transport, timeout=30) as client:
            assert client.get(f"{found[1]}api/health").json()["status"] == "ok"
        process.send_signal(signal.SIGINT)
        _, rest = process.communicate(timeout=30)
        assert process.returncode == 0
        assert b"Traceback" not in rest
        assert re.fullmatch(rb"\d\d:\d\d:\d\d GET /api/health 200 \d\.\d{3}s\n", rest), rest
    finally:
        process.kill()
        process.wait()


def test_port_in_use(intaglio: Command) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        done = intaglio("serve", "--port", str(port))
    assert done.returncode == 1
    assert done.stderr.startswith(f"cannot listen on 127.0.0.1, port {port}: ".encode())


def test_no_such_host(intaglio: Command) -> None:
    done = intaglio("serve", "--host", "no.such.host.invalid")
    assert done.returncode == 1
    assert done.stderr.startswith(b"cannot listen on no.such.host.invalid")

"""Runs the service until it is told to stop."""

from __future__ import annotations

import contextlib
import dataclasses
import logging
import socket
import sys
from collections.abc import Callable

import uvicorn

from renderer import pipeline
from service import COMPILING
from service.app import create
from service.settings import Settings


class ServerError(Exception):
    """The service cannot start; the message is for the user."""


def run(host: str, port: int, say: Callable[[str], None]) -> None:
    """Listen on `host` and `port` until Ctrl-C."""
    try:
        settings = dataclasses.replace(Settings.from_environment(), host=host)
    except ValueError as error:
        raise ServerError(str(error)) from None
    listener = _listen(host, port)
    logging.basicConfig(stream=sys.stderr, format="%(asctime)s %(message)s", datefmt="%H:%M:%S")
    logging.getLogger("intaglio").setLevel(logging.INFO)
    name = f"[{host}]" if ":" in host else host
    say(f"intaglio: http://{name}:{listener.getsockname()[1]}/ (Ctrl-C stops it)")
    if settings.warm_up and not pipeline.kernels_compiled():
        say(COMPILING)
    config = uvicorn.Config(
        create(settings), log_level="warning", access_log=False, timeout_graceful_shutdown=3, server_header=False
    )
    with contextlib.suppress(KeyboardInterrupt):
        uvicorn.Server(config).run(sockets=[listener])


def _listen(host: str, port: int) -> socket.socket:
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        listener = socket.socket(family, kind, protocol)
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(address)
    except OSError as error:
        raise ServerError(f"cannot listen on {host}, port {port}: {error.strerror or error}") from None
    return listener

"""The real service, the built page in a real browser, and what a user does with it."""

from __future__ import annotations

import base64
import json
import shutil
import socket
import subprocess
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
import uvicorn
from playwright.sync_api import Browser, FilePayload, Locator, Page, expect, sync_playwright

from service.app import create
from service.settings import Settings

WEB = Path(__file__).resolve().parents[2] / "web"
FLAGS = ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--no-first-run", "--disable-quic"]
DRAFT = 48  # pixels of a draft's longer side; the sharp picture has twice as many
PATIENCE = 30_000  # milliseconds until a picture is there
COMPILING = 300  # seconds until the kernels are, at a first start

SCENE: dict[str, Any] = {
    "intaglio": 1,
    "camera": {"origin": [0, -2.6, 2.2], "target": [0, 0, 0], "fov": 45, "resolution": [64, 48]},
    "lights": [{"type": "directional", "direction": [-1, 0.3, -0.8], "irradiance": [3, 3, 3]}],
    "materials": {"stone": {"base_color": [0.7, 0.7, 0.7], "roughness": 1, "specular": 0}},
    "patterns": {
        "plate": {
            "grooves": [
                {
                    "path": {"type": "polyline", "points": [[1, 0.5], [1, 3.5]]},
                    "profile": {"type": "v", "width": 0.4, "depth": 0.2},
                },
                {
                    "path": {"type": "polyline", "points": [[2, 1], [3.5, 1], [3.5, 3]]},
                    "profile": {"type": "trapezoid", "width": 0.3, "floor": 0.1, "depth": 0.15},
                },
            ]
        }
    },
    "objects": [
        {
            "shape": {"type": "rectangle", "size": [2, 2]},
            "mapping": {"scale": [4, 4], "offset": [0, 0]},
            "material": "stone",
            "pattern": "plate",
        }
    ],
}


@dataclass
class Editor:
    """The page, as its user sees it."""

    page: Page
    errors: list[str] = field(default_factory=list)

    def open(self, scene: dict[str, Any] | str, name: str = "scene.json") -> None:
        text = scene if isinstance(scene, str) else json.dumps(scene)
        file = FilePayload(name=name, mimeType="application/json", buffer=text.encode())
        self.page.get_by_label("Scene file").set_input_files(file)

    def save(self) -> tuple[str, str]:
        """The name and the text of the file that Save gives."""
        with self.page.expect_download() as download:
            self.page.get_by_role("button", name="Save").click()
        return download.value.suggested_filename, Path(download.value.path()).read_text()

    def document(self) -> dict[str, Any]:
        found = json.loads(self.save()[1])
        assert isinstance(found, dict)
        return found

    def grooves(self) -> list[dict[str, Any]]:
        found = self.document()["patterns"]["plate"]["grooves"]
        assert isinstance(found, list)
        return found

    def picture(self, timeout: int = PATIENCE) -> bytes:
        """The sharp picture of the document as it is now."""
        self.page.wait_for_function(
            """() => {
              const shown = document.querySelector(".preview").dataset;
              return shown.revision === document.body.dataset.revision && shown.quality === "sharp";
            }""",
            timeout=timeout,
        )
        text = self.page.evaluate(
            """async () => {
              const picture = await fetch(document.querySelector(".preview img").src);
              const bytes = new Uint8Array(await picture.arrayBuffer());
              return btoa(String.fromCharCode(...bytes));
            }"""
        )
        return base64.b64decode(text)

    def at(self, p: float, q: float) -> tuple[float, float]:
        """Where a point of the pattern is on the screen, as long as all of SCENE's plate is shown."""
        box = self.page.locator("canvas.plane").bounding_box()
        assert box is not None
        zoom = 0.86 * min(box["width"], box["height"]) / 4
        return box["x"] + box["width"] / 2 + (p - 2) * zoom, box["y"] + box["height"] / 2 - (q - 2) * zoom

    def click(self, p: float, q: float) -> None:
        self.page.mouse.click(*self.at(p, q))

    def drag(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        """From one place of the screen to another."""
        self.page.mouse.move(*start)
        self.page.mouse.down()
        self.page.mouse.move(*end, steps=4)
        self.page.mouse.up()

    def field(self, label: str) -> Locator:
        return self.page.get_by_label(label, exact=True)

    def row(self, number: int) -> Locator:
        return self.page.get_by_role("list", name="Grooves").get_by_role("button").nth(number)


@pytest.fixture(scope="session")
def address() -> Iterator[str]:
    """The service behind a socket."""
    _build()
    listener = socket.create_server(("127.0.0.1", 0))
    app = create(Settings())
    server = uvicorn.Server(uvicorn.Config(app, log_level="warning", timeout_graceful_shutdown=2))
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
    thread.start()
    deadline = time.monotonic() + 20
    while not server.started:
        assert time.monotonic() < deadline, "the service did not start"
        time.sleep(0.02)
    try:
        assert app.state.kernels_ready.wait(COMPILING), "the kernels did not get ready"
        yield f"http://127.0.0.1:{listener.getsockname()[1]}"
    finally:
        server.should_exit = True
        thread.join()


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """The system's Chromium, or Playwright's own."""
    found = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    with sync_playwright() as playwright:
        opened = playwright.chromium.launch(executable_path=found, args=FLAGS)
        yield opened
        opened.close()


@pytest.fixture
def fresh(browser: Browser, address: str) -> Iterator[Editor]:
    """The page as on a first visit. No error of its scripts goes unseen."""
    context = browser.new_context(viewport={"width": 1280, "height": 800}, base_url=address)
    editor = Editor(context.new_page())
    editor.page.on("pageerror", lambda error: editor.errors.append(str(error)))
    editor.page.goto(f"/?preview={DRAFT}")
    yield editor
    context.close()
    assert editor.errors == []


@pytest.fixture
def editor(fresh: Editor) -> Editor:
    """The page with SCENE open."""
    expect(fresh.page.locator(".file-name")).not_to_have_text("untitled.json")
    fresh.open(SCENE)
    expect(fresh.page.locator(".file-name")).to_have_text("scene.json")
    return fresh


def _build() -> None:
    if (WEB / "dist" / "index.html").is_file():
        return
    npm = shutil.which("npm")
    if npm is None or not (WEB / "node_modules").is_dir():
        pytest.fail("the page is not built: `make test` does it, or `npm ci && npm run build` in web/")
    subprocess.run([npm, "run", "build"], cwd=WEB, check=True)

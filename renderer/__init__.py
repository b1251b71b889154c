"""The renderer: a scene in, a picture out.

numba caches a compiled kernel by the file it stands in and overlooks edits to the functions it calls in other files.
So the cache lives in a folder named after the sources of all kernels, and after where they stand, as numba looks for
its own by that, too; it must be named before numba is imported.
"""

import hashlib
import os
import sys
import tempfile
from pathlib import Path


def _cache_directory() -> Path:
    """A writable folder for compiled kernels, one for each place and each state of the sources."""
    digest = hashlib.sha256(f"{sys.version} {Path(__file__).parent}".encode())
    for source in sorted(Path(__file__).parent.rglob("*.py")):
        digest.update(source.read_bytes())
    name = f"kernels-{digest.hexdigest()[:16]}"
    home = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "intaglio"
    for folder in (home / name, Path(tempfile.gettempdir()) / f"intaglio-{os.getuid()}" / name):
        try:
            folder.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=folder):
                return folder
        except OSError:
            continue
    return Path(tempfile.mkdtemp(prefix="intaglio-"))


CACHE = _cache_directory()
os.environ["NUMBA_CACHE_DIR"] = str(CACHE)

"""Writing one file so that it is whole or not there."""

from __future__ import annotations

import os
from pathlib import Path

from xei_lang.diagnostics import Diagnostic, Diagnostics


def write_text(path: Path, text: str) -> Diagnostics:
    """Write beside the target, then rename; a refusal of the system comes back as a diagnostic."""
    if path.is_dir():
        message = f"`{path}` is a folder, and a file was to be written"
        return (Diagnostic("XEI0101", message, help=("name a file with -o",)),)
    aside = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with aside.open("w", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        aside.replace(path)
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        help = ("choose another place with -o",)
        return (Diagnostic("XEI0101", f"`{path}` cannot be written: {reason}", help=help),)
    finally:
        aside.unlink(missing_ok=True)
    return ()

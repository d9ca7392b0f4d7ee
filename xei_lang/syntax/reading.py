"""Reading source files: the one place of the front end that touches the disk."""

from __future__ import annotations

from pathlib import Path

from xei_lang.diagnostics import Diagnostic, Diagnostics, Source

MAX_BYTES = 16 * 1024 * 1024


def read_source(path: Path, shown: str) -> tuple[Source | None, Diagnostics]:
    """The text of a file, named `shown` in messages; None with a diagnostic where it cannot be had.

    A byte order mark is kept out of the text. Line ends stay as they are.
    """
    try:
        # To open a pipe would wait for one who writes into it, who may never come.
        if not path.is_file() and path.exists() and not path.is_dir():
            return None, (Diagnostic("XEI0101", f"`{shown}` is no regular file"),)
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        return None, (_unreadable(shown, error),)
    return decode_source(data, shown, MAX_BYTES)


def decode_source(data: bytes, shown: str, limit: int) -> tuple[Source | None, Diagnostics]:
    """The text that bytes stand for, as `read_source` gives it; `limit` is how many there may be."""
    if len(data) > limit:
        message = f"`{shown}` is larger than {limit // 1024**2} MiB"
        return None, (Diagnostic("XEI0107", message),)
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        return None, (_not_utf8(shown, data, error.start),)
    return Source(shown, text.removeprefix("\ufeff")), ()


def _unreadable(shown: str, error: OSError | ValueError) -> Diagnostic:
    match error:
        case IsADirectoryError():
            reason, advice = "is a folder, not a file", ("name a .xei file inside it",)
        case FileNotFoundError():
            reason, advice = "does not exist", ()
        case PermissionError():
            reason, advice = "may not be read", ("check the file's permissions",)
        case _:
            reason, advice = f"cannot be read: {getattr(error, 'strerror', None) or error}", ()
    return Diagnostic("XEI0101", f"`{shown}` {reason}", help=advice)


def _not_utf8(shown: str, data: bytes, start: int) -> Diagnostic:
    line = data.count(b"\n", 0, start) + 1
    where = f"byte 0x{data[start]:02X} in line {line}, at offset {start}"
    encodings = {b"\xff\xfe": "UTF-16", b"\xfe\xff": "UTF-16", b"PK": "a zip archive"}
    likely = encodings.get(data[:2])
    help_ = f"it looks like {likely}; save it as UTF-8" if likely else "save the file as UTF-8"
    return Diagnostic("XEI0102", f"`{shown}` is not UTF-8 text", notes=(where,), help=(help_,))

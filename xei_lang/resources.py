"""Where the files that come with xei lie: in the installed package, or in a working copy of the project."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent


def resource_path(name: str) -> Path:
    """The path of a file or folder that comes with xei: `grammar/xei.lark`, `profiles/openarm_bench`.

    An installed package carries them under `_data/`; in a working copy they stand beside the package.
    The path is not promised to exist: what is missing is for the caller to report.
    """
    packaged = _PACKAGE / "_data" / name
    return packaged if packaged.exists() else _PACKAGE.parent / name

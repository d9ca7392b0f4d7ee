"""What the exit code of `xei` means; other programs rely on these."""

from __future__ import annotations

from typing import Final

DONE: Final = 0
INPUT_HAS_ERRORS: Final = 1
"""The protocol, the profile or the world has errors."""
WRONG_USAGE: Final = 2
"""Wrong usage, or a file that is missing or cannot be read or written."""
RUN_STOPPED: Final = 3
"""A run stopped on a failure."""
OUR_BUG: Final = 70
"""An internal error (EX_SOFTWARE of sysexits)."""
INTERRUPTED: Final = 130
"""Ctrl-C, as shells say it (128 + SIGINT)."""

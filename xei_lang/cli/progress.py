"""A progress bar for long passes: on a terminal only, and only once a second has gone by."""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass, field

_WIDTH = 30


@dataclass(slots=True)
class Bar:
    """Called with a pass's name, how much is done and how much there is; draws over its own line."""

    started: float = field(default_factory=time.monotonic)
    drawn: bool = False

    def __call__(self, name: str, done: int, total: int) -> None:
        """Draw the bar anew."""
        if not sys.stderr.isatty() or time.monotonic() - self.started < 1.0:
            return
        filled = _WIDTH * done // max(total, 1)
        sys.stderr.write(f"\r{name:<8} [{'#' * filled}{' ' * (_WIDTH - filled)}] {done}/{total}")
        self.drawn = True
        if done >= total:
            self.clear()
        sys.stderr.flush()

    def clear(self) -> None:
        """Wipe the bar away, so that what is printed next has its line to itself."""
        if self.drawn:
            sys.stderr.write("\r" + " " * (_WIDTH + 24) + "\r")
            self.drawn = False

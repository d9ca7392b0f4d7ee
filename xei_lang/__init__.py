"""xei: a compiler from laboratory protocols to safe, timed robot motion."""

from __future__ import annotations

__version__ = "0.1.0"

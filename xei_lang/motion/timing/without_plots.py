"""Libraries imported without the plotting that they import for their own use."""

from __future__ import annotations

import sys
from collections.abc import Generator
from contextlib import contextmanager
from types import ModuleType

_PLOTTING = ("matplotlib", "matplotlib.pyplot")


@contextmanager
def without_plots() -> Generator[None]:
    """What is imported within sees an empty matplotlib, unless the real one is there already: it costs as
    much as all that xei itself imports. Afterwards it can be imported by whoever draws.
    """
    absent = [name for name in _PLOTTING if name not in sys.modules]
    sys.modules.update({name: ModuleType(name) for name in absent})
    try:
        yield
    finally:
        for name in absent:
            del sys.modules[name]

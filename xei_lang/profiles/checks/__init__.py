"""What no single file of a profile can be judged by: names across files, and geometry. One concern a file."""

from __future__ import annotations

from xei_lang.diagnostics import Diagnostics
from xei_lang.profiles.model import Profile


def check_profile(profile: Profile) -> Diagnostics:
    """All cross checks of a profile, in a fixed order."""
    return ()

"""What no single file of a profile can be judged by: names across files, templates, geometry. One concern a
file.
"""

from __future__ import annotations

from xei_lang.diagnostics import Diagnostics, has_errors
from xei_lang.profiles.checks.arguments import check_arguments
from xei_lang.profiles.checks.contradictions import check_contradictions
from xei_lang.profiles.checks.elements import check_elements
from xei_lang.profiles.checks.frames import check_frames
from xei_lang.profiles.checks.geometry import check_geometry
from xei_lang.profiles.checks.limits import check_limits
from xei_lang.profiles.checks.names import check_names
from xei_lang.profiles.checks.overlap import check_overlap
from xei_lang.profiles.checks.owners import check_owners
from xei_lang.profiles.checks.priors import check_priors
from xei_lang.profiles.checks.quantities import check_quantities
from xei_lang.profiles.checks.rules import check_rules
from xei_lang.profiles.checks.skills import check_skills
from xei_lang.profiles.checks.template_order import check_template_order
from xei_lang.profiles.checks.threads import check_threads
from xei_lang.profiles.checks.tips import check_tips
from xei_lang.profiles.checks.unused import check_unused
from xei_lang.profiles.checks.words import check_words
from xei_lang.profiles.model import Profile
from xei_lang.profiles.trees import Trees


def check_profile(profile: Profile, trees: Trees) -> Diagnostics:
    """All cross checks, in a fixed order; whether objects overlap only where all have a place."""
    found = (
        *check_names(profile, trees),
        *check_words(profile, trees),
        *check_skills(profile, trees),
        *check_arguments(profile, trees),
        *check_quantities(profile, trees),
        *check_owners(profile, trees),
        *check_rules(profile),
        *check_contradictions(profile),
        *check_template_order(profile),
        *check_unused(profile),
        *check_frames(profile, trees),
        *check_limits(profile, trees),
        *check_priors(profile),
        *check_geometry(profile, trees),
        *check_elements(profile),
        *check_tips(profile),
        *check_threads(profile, trees),
    )
    return found if has_errors(found) else (*found, *check_overlap(profile))

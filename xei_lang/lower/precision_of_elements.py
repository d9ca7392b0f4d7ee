"""How well a step that touches a screen must know where its elements are."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.ir.skill_plan import ObjectRef, Step
from xei_lang.lower.precision_of_tips import Fit
from xei_lang.world.precision import Benches


def element_fits(step: Step, benches: Benches) -> Iterator[Fit]:
    """The elements that a step names of a screen that it names."""
    named = [item.value for item in step.args if isinstance(item.value, str)]
    for argument in step.args:
        value = argument.value
        screen = benches.profile.object(value.name) if isinstance(value, ObjectRef) else None
        for element in screen.elements if screen else ():
            found = benches.element(screen, element) if screen and element.name in named else None
            if screen and found is not None:
                yield Fit(step.skill, element.name, screen.name, found, "the element takes an error of")

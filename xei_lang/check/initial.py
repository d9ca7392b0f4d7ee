"""What is known before the first step: empty hands, and where the profile believes things to stand."""

from __future__ import annotations

from xei_lang.check.registry import Registry
from xei_lang.check.state import NOTHING, State
from xei_lang.ir.skill_plan import PlaceRef
from xei_lang.profiles.model import LabObject
from xei_lang.world.places import initial_place


def initial_state(registry: Registry) -> State:
    """Nothing in the hands; each object where its prior has it; declared states with their initial values.

    An object whose prior is a pose in the frame of a bench stands somewhere on that bench.
    """
    state = State(registry.arms)
    for arm in registry.arms:
        state.set("holding", arm, NOTHING)
    for thing in registry.objects.values():
        place = None if thing.system else _place(thing, registry)
        if place is not None:
            state.set("at", thing.name, place)
        for declared in thing.states:
            state.set(declared.name, thing.name, declared.initial)
    return state


def _place(thing: LabObject, registry: Registry) -> PlaceRef | None:
    place = initial_place(thing)
    if place is not None or thing.prior is None:
        return place
    bench = registry.objects.get(thing.prior.frame)
    return None if bench is None or bench is thing else PlaceRef(bench.name, "surface", "")

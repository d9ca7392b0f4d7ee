"""What is known at each point of the plan: a forward walk over what skills say they bring about.

Only facts are kept here, none are judged. With `arm=either` it is not known which arm holds the object: then
`holding(either)` is a fact, and those of the arms that it could be are withdrawn until the object is put
down.
"""

from __future__ import annotations

from bisect import bisect_left, insort
from collections.abc import Iterable

from xei_lang.check.values import Poison, to_plan
from xei_lang.check.volumes import Amount, Volumes
from xei_lang.check.works import Works
from xei_lang.diagnostics import Span
from xei_lang.ir.skill_plan import Fact, ObjectRef, PlaceRef, Value

NOTHING = "nothing"
EITHER = "either"

_Key = tuple[str, str]


class State:
    """Facts by variable and subject; reading them all is cheap as long as nothing changes in between."""

    def __init__(self, arms: tuple[str, ...]) -> None:
        self._arms = arms
        self._facts: dict[_Key, Fact] = {}
        self._order: list[_Key] = []
        self._listed: tuple[Fact, ...] | None = ()
        self._occupants: dict[PlaceRef, str] = {}
        self._taken_from: dict[PlaceRef, str] = {}
        self._in_either: tuple[str, ...] = ()
        self._touched: set[_Key] = set()
        self.ended: Span | None = None
        """The `stop` that ended the run before this point, which is then never reached."""
        self.works = Works()
        self.volumes = Volumes()

    def copy(self) -> State:
        """A state of its own, for the other branch of a choice."""
        twin = State(self._arms)
        twin._facts = dict(self._facts)
        twin._order = list(self._order)
        twin._listed = self._listed
        twin._occupants = dict(self._occupants)
        twin._taken_from = dict(self._taken_from)
        twin._in_either = self._in_either
        twin._touched = set(self._touched)
        twin.ended = self.ended
        twin.works = self.works
        twin.volumes = self.volumes.copy()
        return twin

    def fork(self) -> State:
        """A state of its own for a branch that may overlap with others; `changed` then is what it changed."""
        twin = self.copy()
        twin._touched = set()
        return twin

    @property
    def changed(self) -> frozenset[tuple[str, str]]:
        """Variable and subject of each fact that was ever changed since `fork`."""
        return frozenset((variable, subject.partition(":")[0]) for variable, subject in self._touched)

    def adopt(self, base: State, branch: State) -> None:
        """Take over what a branch, forked from `base`, has changed; branches that overlap change different
        things.
        """
        for key in sorted(branch._touched):
            fact = branch._facts.get(key)
            if fact == base._facts.get(key):
                continue
            if fact is not None:
                self._store(key, fact)
            else:
                self._drop(key)
        for own, before, after in (
            (self._occupants, base._occupants, branch._occupants),
            (self._taken_from, base._taken_from, branch._taken_from),
        ):
            for place in before.keys() - after.keys():
                own.pop(place, None)
            own.update(item for item in after.items() if before.get(item[0]) != item[1])
        self.ended = self.ended or branch.ended
        self.works = self.works.adopt(base.works, branch.works)
        gone = set(base._in_either) - set(branch._in_either)
        new = tuple(name for name in branch._in_either if name not in base._in_either)
        self._in_either = (*(name for name in self._in_either if name not in gone), *new)
        self.volumes.adopt(base.volumes, branch.volumes)

    def join(self, other: State) -> State:
        """What is known whichever of two branches was taken: the facts that both share. A branch that ended
        the run says nothing of what follows.
        """
        if self.ended or other.ended:
            return other.copy() if self.ended else self.copy()
        both = self.copy()
        for key in self._order:
            if other._facts.get(key) != self._facts[key]:
                both._drop(key)
        both._occupants = dict(self._occupants.items() & other._occupants.items())
        both._taken_from = dict(self._taken_from.items() & other._taken_from.items())
        both._touched |= other._touched
        both.works = self.works.join(other.works)
        both._in_either = tuple(name for name in self._in_either if name in other._in_either)
        both.volumes = self.volumes.join(other.volumes)
        return both

    def facts(self) -> tuple[Fact, ...]:
        """All facts, sorted by variable and subject; the same tuple until something changes."""
        if self._listed is None:
            self._listed = tuple(self._facts[key] for key in self._order)
        return self._listed

    @property
    def hands(self) -> tuple[Fact, ...]:
        """What is known of the hands, sorted."""
        return tuple(fact for fact in self.facts() if fact.variable == "holding")

    def get(self, variable: str, subject: str) -> Value | None:
        """The known value of a state variable, or None."""
        fact = self._facts.get((variable, subject))
        return fact.value if fact else None

    def occupant(self, place: PlaceRef) -> str | None:
        """What stands in a place; while an object is in a hand, the place that it left still means it."""
        return self._occupants.get(place) or self._taken_from.get(place)

    def set(self, variable: str, subject: str, value: Value) -> None:
        """Let a state variable have a value; `holding` and `at` keep each other right."""
        if variable == "holding":
            self._set_holding(subject, value)
        elif variable == "at":
            self._set_at(subject, value)
        else:
            self._put(variable, subject, value)

    def set_volume(self, name: str, amount: Amount) -> None:
        """Let a thing hold an amount; its fact is the nominal one."""
        self.volumes.set(name, amount)
        if isinstance(amount.value, Poison):
            self._drop(("volume", name))
        else:
            self._put("volume", name, to_plan(amount.value))

    def set_all(self, facts: Iterable[tuple[str, str, Value]]) -> None:
        """Set several, in order."""
        for variable, subject, value in facts:
            self.set(variable, subject, value)

    def release(self, arm: str, objects: Iterable[str]) -> None:
        """An arm lets go; with `either` it is the one that has one of the objects."""
        if arm != EITHER:
            self._put("holding", arm, NOTHING)
            return
        for name in objects:
            holder = self.holder(name)
            if holder == EITHER:
                self._in_either = tuple(other for other in self._in_either if other != name)
                self._drop(("holding", f"{EITHER}:{name}"))
                self._settle_arms()
            elif holder is not None:
                self._put("holding", holder, NOTHING)

    def holder(self, name: str) -> str | None:
        """The arm that has an object, `either` where only that is known, None where no arm is known to have
        it.
        """
        if name in self._in_either:
            return EITHER
        return next((arm for arm in self._arms if self.get("holding", arm) == ObjectRef(name)), None)

    def _set_holding(self, arm: str, value: Value) -> None:
        if not isinstance(value, ObjectRef):
            self.release(arm, ())
            return
        if arm == EITHER:
            free = [side for side in self._arms if self.get("holding", side) == NOTHING]
            if len(free) == 1 and not self._in_either:
                arm = free[0]
        if arm == EITHER:
            self._in_either = (*self._in_either, value.name)
            for side in self._arms:
                if self.get("holding", side) == NOTHING:
                    self._drop(("holding", side))
            self._store(("holding", f"{EITHER}:{value.name}"), Fact("holding", EITHER, value))
        else:
            self._put("holding", arm, value)
        self._set_at(value.name, arm)

    def _settle_arms(self) -> None:
        """Once no object is in an unknown hand, every arm of which nothing else is known is empty."""
        if not self._in_either:
            for side in self._arms:
                if self.get("holding", side) is None:
                    self._put("holding", side, NOTHING)

    def _set_at(self, name: str, value: Value) -> None:
        before = self.get("at", name)
        if isinstance(before, PlaceRef) and self._occupants.get(before) == name:
            del self._occupants[before]
            if not isinstance(value, PlaceRef):
                self._taken_from[before] = name
        if isinstance(value, PlaceRef):
            for place in [place for place, taken in self._taken_from.items() if taken == name]:
                del self._taken_from[place]
            if value.kind != "surface":
                self._occupants[value] = name
        self._put("at", name, value)

    def _put(self, variable: str, subject: str, value: Value) -> None:
        self._store((variable, subject), Fact(variable, subject, value))

    def _store(self, key: _Key, fact: Fact) -> None:
        known = self._facts.get(key)
        if known == fact:
            return
        self._touched.add(key)
        if known is None:
            insort(self._order, key)
        self._facts[key] = fact
        self._listed = None

    def _drop(self, key: _Key) -> None:
        if self._facts.pop(key, None) is not None:
            self._touched.add(key)
            del self._order[bisect_left(self._order, key)]
            self._listed = None

"""One step while its template is expanded: what its names mean, its plans so far, and the scene as it
changes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NoReturn

from xei_lang.diagnostics import Span
from xei_lang.ir.families import Family
from xei_lang.ir.goals import Parameter
from xei_lang.ir.skill_plan import ObjectRef, PlaceRef, Side, StationRef, Step, Value
from xei_lang.lower.arms import Choice, Destination
from xei_lang.lower.derived import cap_meant, leads_to
from xei_lang.lower.hand import SIDES
from xei_lang.lower.operations import OPERATIONS, Operation, Planned, Work, operation_of_point
from xei_lang.lower.parameters import Layers, Setting, layers_of
from xei_lang.lower.refusal import refuse
from xei_lang.lower.riders import refuse_fastened, refuse_set_on_thread
from xei_lang.lower.walk import Scene
from xei_lang.profiles.model import Profile, SceneOrigin, SkillSpec, TemplateStep


@dataclass(slots=True)
class Task:
    """A step being lowered. `scene` and `plans` change as the template's lines are built, in order.

    `arms` are the arms of the step's arm arguments by argument name; `object` is what the step is about (or
    empty).
    """

    profile: Profile
    step: Step
    spec: SkillSpec
    scene: Scene
    arms: Mapping[str, Choice]
    object: str
    ahead: tuple[Destination, ...]
    plans: dict[tuple[str, str, Side], Planned] = field(default_factory=dict[tuple[str, str, Side], Planned])
    families: list[Family] = field(default_factory=list[Family])
    told: set[str] = field(default_factory=set[str])

    def layers(self, subject: str = "") -> Layers:
        """The written settings for an operation on an object (by default on the one that the step is
        about).
        """
        return layers_of(self.step, self.spec, self.profile.object(subject or self.object))

    def argument(self, name: str) -> Value | None:
        """The value of an argument of the step, or what one leads to (`object.cap`), or None."""
        return leads_to(self.profile, self.step, self.span_of(name), name)

    def span_of(self, name: str) -> Span:
        """The user's words for an argument; the whole step where the skill bank supplied it."""
        found = next((item for item in self.step.args if item.name == name.partition(".")[0]), None)
        return found.span if found and found.source == "call" else self.step.span

    def arm(self, name: object, line: TemplateStep) -> Side:
        """The arm that a template field names, by its argument or as itself."""
        if isinstance(name, str) and name in self.arms:
            return self.arms[name].arm
        for side in SIDES:
            if name == side:
                return side
        return refuse_template(
            line, f"`{name}` is not an arm", "expected an argument of type Arm, `left` or `right`"
        )

    def why_arm(self, name: object) -> tuple[Parameter, ...]:
        """Why this arm, said once for each step."""
        if not isinstance(name, str) or name not in self.arms or f"arm {name}" in self.told:
            return ()
        self.told.add(f"arm {name}")
        choice = self.arms[name]
        if choice.reason:
            return (Parameter(name, choice.arm, "computed", choice.reason),)
        return (Parameter(name, choice.arm, "call", "argument", self.span_of(name)),)

    def planned(self, operation: Operation, argument: str, arm: Side, line: TemplateStep) -> Planned:
        """The operation's plan on an argument, made at its first mention in the template."""
        key = (operation.name, argument, arm)
        if key not in self.plans or operation.fresh:
            work = self._work(operation, argument, arm, line)
            refuse_fastened(operation, work)
            refuse_set_on_thread(operation, work)
            planned = operation.plan(work)
            self.plans[key] = planned
            made = planned.family
            known = {family.id for family in self.families}
            if made is not None and made.id == work.family_id and made.id not in known:
                self.families.append(made)
        return self.plans[key]

    def _work(self, operation: Operation, argument: str, arm: Side, line: TemplateStep) -> Work:
        subject = self.argument(argument)
        if not isinstance(subject, (ObjectRef, PlaceRef)):
            refuse_template(
                line, f"`{argument}` has no points of an operation", "expected an object or a Place"
            )
        found = "Place" if isinstance(subject, PlaceRef) else "cap" if "." in argument else "object"
        if found != operation.of:
            wanted = {"object": "an object", "cap": "an object's `cap`", "Place": "a Place"}[operation.of]
            refuse_template(
                line, f"`{argument}` is nothing that `{operation.name}` works on", f"expected {wanted}"
            )
        cap = cap_meant(self.profile, self.step, argument)
        name = subject.name if isinstance(subject, ObjectRef) else cap or self.object
        layers = self.layers(name)
        _refuse_ungiven(operation, layers, self.spec, line)
        return Work(
            self.profile,
            self.scene,
            self.step,
            layers,
            subject,
            self.span_of(argument),
            arm,
            cap or self.object,
            tuple(item.place for item in self.ahead),
            f"{self.step.step_id}.{name}",
        )

    def setting(self, name: str, arm: Side | None, line: TemplateStep) -> Setting:
        """A parameter that a template names: of the call, of an operation of this template, or the skill's
        default. Without an arm only what the lines before have planned is looked through.
        """
        layers = self.layers()
        if name in layers.call:
            return layers.call[name]
        if arm is None:
            plans = (plan.settings for plan in self.plans.values())
            made = next((settings[name] for settings in plans if name in settings), None)
            if made is not None:
                return made
        for operation in OPERATIONS:
            argument = self._subject_of(operation) if name in operation.parameters else None
            if argument is not None and arm is not None:
                found = self.planned(operation, argument, arm, line).settings.get(name)
                if found is not None:
                    return found
        merged = layers.merge(name, None)
        if merged is not None:
            return merged
        return refuse_template(
            line,
            f"`{name}` is no operation parameter of `{self.spec.name}`",
            "neither an argument, nor computed, nor under `parameters`",
        )

    def _subject_of(self, operation: Operation) -> str | None:
        """The argument that the template uses the operation's points on, or None where it does not."""
        for line in self.spec.template:
            argument, _, point = str(line.field("at") or "").rpartition(".")
            if operation_of_point(point) is operation:
                return argument
        return None

    def station(self, name: str, line: TemplateStep) -> SceneOrigin:
        """The station that an argument names."""
        value = self.argument(name)
        found = next(
            (
                item
                for item in self.profile.calibration.stations
                if isinstance(value, StationRef) and item.name == value.name
            ),
            None,
        )
        return found or refuse_template(
            line, f"`{name}` is not a station", "expected an argument of type Station"
        )


def _refuse_ungiven(operation: Operation, layers: Layers, spec: SkillSpec, line: TemplateStep) -> None:
    """Give up a step whose operation needs what neither its call nor the profile gives."""
    asked = [(name, "as an argument") for name in operation.called if name not in layers.call]
    asked += [
        (name, "as an argument or under `parameters`")
        for name in operation.needs
        if layers.merge(name, None) is None
    ]
    for name, where in asked:
        refuse_template(line, f"`{operation.name}` in `{spec.name}` needs `{name}`", f"expected it {where}")


def refuse_template(line: TemplateStep, message: str, label: str, *notes: str) -> NoReturn:
    """Give up the step because its skill's template is wrong, at the profile's own line."""
    refuse("XEI0701", message, line.span, label, notes=notes)

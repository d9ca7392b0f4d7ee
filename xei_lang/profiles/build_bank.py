"""The skill bank, from the validated model to dataclasses: predicates and roles parsed, defaults typed."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import TYPE_CHECKING, TypeVar, get_args

from xei_lang.diagnostics import Diagnostic, Diagnostics, Source, Span, did_you_mean
from xei_lang.ir.goals import GoalKind
from xei_lang.profiles.build_objects import operation_defaults
from xei_lang.profiles.model import (
    ArgSpec,
    Repeat,
    ReturnSpec,
    SkillBank,
    SkillRule,
    SkillSpec,
    TemplateStep,
)
from xei_lang.profiles.schema.development import (
    ArgModel,
    DevelopmentProfile,
    GoalLine,
    RepeatLine,
    ReturnModel,
    SkillModel,
)
from xei_lang.profiles.yaml_tree import Node, Path
from xei_lang.quantity import TYPE_DIMENSIONS, Quantity, QuantityError, parse_quantity
from xei_lang.quantity.dimension import NUMBER
from xei_lang.syntax.parser import Parser

if TYPE_CHECKING:
    from xei_lang.syntax.ast import TypeExpr

KINDS: tuple[GoalKind, ...] = get_args(GoalKind)
_T = TypeVar("_T")


def build_bank(model: DevelopmentProfile, root: Node, text: str, found: list[Diagnostic]) -> SkillBank:
    """The skill bank; what cannot be read is said in `found`."""
    builder = _Bank(root, text, Parser(), found)
    skills = tuple(builder.skill(name, skill) for name, skill in model.skills.items())
    robot = model.robot
    return SkillBank(robot.urdf, robot.srdf, tuple(robot.arms), tuple(robot.owners), skills)


class _Bank:
    def __init__(self, root: Node, text: str, parser: Parser, found: list[Diagnostic]) -> None:
        self.root = root
        self.text = text
        self.parser = parser
        self.found = found

    def skill(self, name: str, model: SkillModel) -> SkillSpec:
        path: Path = ("skills", name)
        return SkillSpec(
            name=name,
            owner=model.owner,
            summary=model.summary,
            args=tuple(self.argument(key, arg, (*path, "args", key)) for key, arg in model.args.items()),
            exposed=model.exposed,
            requires=self.rules(model.requires, (*path, "requires")),
            ensures=self.rules(model.ensures, (*path, "ensures")),
            duration_s=model.duration,
            unsupported=tuple(model.unsupported),
            process=model.process,
            phrases=tuple(model.phrases),
            parameters=operation_defaults(model.parameters, self.root, (*path, "parameters")),
            template=self.template(model, (*path, "template")),
            span=self.root.key_span(*path),
            returns=None if model.returns is None else self.returned(model.returns, (*path, "returns")),
            occupies=tuple(model.occupies),
            touchable=model.touchable,
            occupies_span=self.root.key_span(*path, "occupies") if model.occupies else None,
            min_confidence=model.min_confidence,
            duration_span=self.root.span_of(*path, "duration"),
        )

    def returned(self, model: ReturnModel, path: Path) -> ReturnSpec:
        lower = self._bound(model.type, model.min, (*path, "min"))
        upper = self._bound(model.type, model.max, (*path, "max"))
        span = self.root.key_span(*path)
        if lower is not None and upper is not None and lower.dimension == upper.dimension and lower > upper:
            message = f"nothing lies between {lower} and {upper}"
            self._say("XEI0610", message, span, "`min` is more than `max`", "write the smaller one as `min`")
        return ReturnSpec(model.type, lower, upper, span)

    def rules(self, texts: list[str], path: Path) -> tuple[SkillRule, ...]:
        rules: list[SkillRule] = []
        for index, text in enumerate(texts):
            span = self.root.span_of(*path, index)
            predicate = self._parse(self.parser.predicate, text, span)
            if predicate is not None:
                rules.append(SkillRule(text, predicate, span))
        return tuple(rules)

    def argument(self, name: str, model: ArgModel, path: Path) -> ArgSpec:
        roles: TypeExpr | None = None
        if model.roles is not None:
            roles = self._parse(self.parser.role_expression, model.roles, self.root.span_of(*path, "roles"))
        return ArgSpec(
            name=name,
            type=model.type,
            roles=roles,
            min=self._bound(model.type, model.min, (*path, "min")),
            max=self._bound(model.type, model.max, (*path, "max")),
            default=self._default(model, (*path, "default")),
            required=model.default is None,
            choices=tuple(model.choices or model.places),
            span=self.root.key_span(*path),
            roles_text=model.roles or "",
        )

    def template(self, model: SkillModel, path: Path) -> tuple[TemplateStep, ...]:
        """All goals, in order; what a `repeat` stands for is marked with it."""
        steps: list[TemplateStep | None] = []
        for index, line in enumerate(model.template):
            if not isinstance(line, RepeatLine):
                steps.append(self.goal(line, path, (index,), None))
                continue
            span = self.root.key_span(*path, index, "repeat")
            repeat = Repeat(line.repeat.times, index, span)
            steps.extend(
                self.goal(inner, path, (index, "repeat", "do", number), repeat)
                for number, inner in enumerate(line.repeat.do)
            )
        return tuple(step for step in steps if step is not None)

    def goal(self, line: GoalLine, path: Path, at: Path, repeat: Repeat | None) -> TemplateStep | None:
        if len(line) != 1:
            span = self.root.span_of(*path, *at)
            label = "expected one key, the kind of goal"
            self._say("XEI0609", "a step of a template is one goal", span, label)
            return None
        word, fields = next(iter(line.items()))
        key = self.root.key_span(*path, *at, word)
        kind: GoalKind | None = next((kind for kind in KINDS if kind == word), None)
        if kind is None:
            near = did_you_mean(word, KINDS)
            all_ = "known are " + ", ".join(f"`{kind}`" for kind in KINDS)
            known = f"did you mean `{near[0]}`?" if near else all_
            self._say("XEI0609", f"`{word}` is not a kind of goal", key, "expected a kind of goal", known)
            return None
        return TemplateStep(kind, tuple(fields.items()), key, repeat, at)

    def _bound(self, type_: str, value: Quantity | int | float | None, path: Path) -> Quantity | None:
        """A bound of a quantity's type; bounds of plain numbers are quantities without a unit."""
        if isinstance(value, Quantity):
            self._check_dimension(type_, value, path)
            return value
        if value is None:
            return None
        if type_ in ("Int", "Float"):
            return Quantity(Fraction(str(value)), NUMBER, "")
        self._say(
            "XEI0610", f"`{value}` has no unit", self.root.span_of(*path), f"expected a quantity of {type_}"
        )
        return None

    def _default(self, model: ArgModel, path: Path) -> str | Quantity | int | float | bool | None:
        span = self.root.span_of(*path)
        if model.type == "Pose" and model.default is not None:
            self._say("XEI0610", "a pose has no default", span, "leave it out: each call says its pose")
            return None
        if model.type not in TYPE_DIMENSIONS or model.default is None:
            return model.default
        try:
            value = parse_quantity(str(model.default))
        except QuantityError as error:
            self._say("XEI0610", error.reason, span, f"expected a quantity of {model.type}")
            return None
        self._check_dimension(model.type, value, path)
        return value

    def _check_dimension(self, type_: str, value: Quantity, path: Path) -> None:
        if value.dimension not in TYPE_DIMENSIONS.get(type_, ()):
            message = f"`{value}` is a quantity of {value.dimension.name}, expected {type_}"
            self._say("XEI0610", message, self.root.span_of(*path), f"expected {type_}")

    def _parse(
        self, parse: Callable[[Source], tuple[_T | None, Diagnostics]], text: str, span: Span
    ) -> _T | None:
        """Parse a text of the profile; spans point into the YAML file, where it stands in one line."""
        written = self.text[span.start : span.end]
        start = span.start + (1 if written[:1] in ("'", '"') else 0)
        value, faults = parse(Source(span.file, " " * start + text))
        for fault in faults:
            label = fault.label or fault.message
            message = f"`{text}` cannot be read as an expression of the language"
            self.found.append(
                Diagnostic(
                    "XEI0622", message, fault.span or span, label, notes=(fault.message,), help=fault.help
                )
            )
        return value

    def _say(self, code: str, message: str, span: Span, label: str, *help_: str) -> None:
        self.found.append(Diagnostic(code, message, span, label, help=help_))

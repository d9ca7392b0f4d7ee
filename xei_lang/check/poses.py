"""The function `pose`: where something is and how it is turned, in a frame of the deployment."""

from __future__ import annotations

from xei_lang.check.arguments import Signature, match_arguments
from xei_lang.check.expectation import Expectation
from xei_lang.check.lists import Evaluate
from xei_lang.check.quantities import no_such_type, quantity_value
from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter, guess, listed, meant, replace
from xei_lang.check.run_time import known_now
from xei_lang.check.scope import Scope
from xei_lang.check.values import POISON, Interval, OpenPose, Val
from xei_lang.diagnostics import did_you_mean
from xei_lang.ir.skill_plan import PoseIn
from xei_lang.quantity import Quantity, quantity
from xei_lang.syntax.ast import Arg, Call, CallExpr, Expression, Name

POSE = "pose"
EXAMPLE = 'pose(x=0.3 m, y=0 m, z=0.1 m, yaw=90 deg, frame="table")'

_LENGTHS = ("x", "y", "z")
_ANGLES = ("roll", "pitch", "yaw")
_SIGNATURE = Signature("function", POSE, (*_LENGTHS, *_ANGLES, "frame"), (*_LENGTHS, "frame"), None)
_NO_TURN = quantity(0, "deg")


class Poses:
    """Evaluates calls of `pose`."""

    def __init__(self, registry: Registry, reporter: Reporter, evaluate: Evaluate) -> None:
        self._registry = registry
        self._reporter = reporter
        self._evaluate = evaluate

    def value(self, function: Name, node: CallExpr, scope: Scope) -> Val:
        """The pose; POISON where a part is missing or wrong, each of which is reported."""
        given = match_arguments(Call(function, node.args, node.span), _SIGNATURE, self._reporter)
        if given is None or len(given) < len(node.args):
            for arg in node.args if given is None else ():
                self._evaluate(arg.value, scope)
            return POISON
        found = [self._part(name, given.get(name), scope) for name in (*_LENGTHS, *_ANGLES)]
        frame = self._frame(given["frame"].value, scope)
        parts = tuple(part for part in found if part is not None)
        if frame is None or len(parts) < len(found):
            return POISON
        x, y, z, roll, pitch, yaw = (_nominal(part) for part in parts)
        pose = PoseIn(frame, (x, y, z), (roll, pitch, yaw))
        is_open = any(isinstance(part, Interval) for part in parts)
        return OpenPose(pose, parts) if is_open else pose

    def _part(self, name: str, arg: Arg | None, scope: Scope) -> Quantity | Interval | None:
        if arg is None:
            return _NO_TURN
        type_ = "Length" if name in _LENGTHS else "Angle"
        expected = Expectation(f"`{name}` of `{POSE}`", type_)
        value = known_now(self._evaluate(arg.value, scope), expected.what, arg.value.span, self._reporter)
        if value is POISON:
            return None
        value = quantity_value(value, expected, arg.value, self._reporter)
        return value if isinstance(value, (Quantity, Interval)) else None

    def _frame(self, node: Expression, scope: Scope) -> str | None:
        if isinstance(node, Name) and scope.find(node.id) is None:
            self._unknown(node.id, node)
            return None
        value = self._evaluate(node, scope)
        if not isinstance(value, str):
            if value is not POISON:
                no_such_type(value, Expectation(f"`frame` of `{POSE}`", "String"), node, self._reporter)
            return None
        if value not in self._registry.frames:
            self._unknown(value, node)
            return None
        return value

    def _unknown(self, name: str, node: Expression) -> None:
        """Report a frame that does not exist, or whose name stands without its quotes."""
        frames = self._registry.frames
        if name in frames:
            message, label = f"the name of the frame `{name}` is a text", "expected a text"
            help, fix = (f'write `"{name}"`',), replace(node.span, f'"{name}"')
        else:
            near = tuple(f'"{frame}"' for frame in did_you_mean(name, frames))
            message, label = (
                f"there is no frame `{name}`",
                "no frame of the calibration profile has this name",
            )
            help, fix = meant(near) or (f"frames are {listed(frames, 12)}",), guess(node.span, near)
        self._reporter.report("XEI0202", message, node.span, label, help=help, fix=fix)


def _nominal(part: Quantity | Interval) -> Quantity:
    value = part.nominal if isinstance(part, Interval) else part
    assert isinstance(value, Quantity)  # as `quantity_value` sees to for both ends
    return value

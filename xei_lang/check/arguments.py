"""Which argument is which: the ones of a call against the ones that a skill or procedure declares."""

from __future__ import annotations

from collections.abc import Mapping

from xei_lang.check.report import Reporter, insert, listed, meant
from xei_lang.diagnostics import Edit, Fix, Label, Span, did_you_mean
from xei_lang.record import Shown, record
from xei_lang.syntax.ast import Arg, Call


@record
class Signature(Shown):
    """What can be called: `kind` is `skill` or `procedure`; `rule` is its place in a profile, if any."""

    kind: str
    name: str
    formals: tuple[str, ...]
    required: tuple[str, ...]
    rule: Span | None

    @property
    def text(self) -> str:
        """The call as it could be written: `pick(object=..., arm=...)`."""
        return f"{self.name}({', '.join(f'{name}=...' for name in self.formals)})"


def match_arguments(call: Call, signature: Signature, reporter: Reporter) -> Mapping[str, Arg] | None:
    """The arguments of a call by name; None where one that is required is missing.

    Unknown, repeated and nameless arguments are reported too; a nameless one is then taken to be the one
    that its place suggests, so that its value is checked as well.
    """
    found: dict[str, Arg] = {}
    unknown = False
    for position, arg in enumerate(call.args):
        name = _name(arg, position, signature, reporter)
        if name is None:
            unknown = True
        elif name in found:
            _twice(name, arg, found[name], reporter)
        else:
            found[name] = arg
    missing = tuple(name for name in signature.required if name not in found)
    if missing and not unknown:
        _missing(call, signature, missing, reporter)
    return None if missing else found


def _name(arg: Arg, position: int, signature: Signature, reporter: Reporter) -> str | None:
    if arg.name is None:
        return _nameless(arg, position, signature, reporter)
    name = arg.name.id
    if name in signature.formals:
        return name
    suggestions = did_you_mean(name, signature.formals)
    reporter.report(
        "XEI0301",
        f"{signature.kind} `{signature.name}` has no argument `{name}`",
        arg.name.span,
        f"expected {listed(signature.formals)}" if signature.formals else "expected no argument",
        notes=(reporter.rule(signature.rule),) if signature.rule else (),
        help=meant(suggestions),
        fix=Fix("unsafe", (Edit(arg.name.span, suggestions[0]),)) if len(suggestions) == 1 else None,
    )
    return None


def _nameless(arg: Arg, position: int, signature: Signature, reporter: Reporter) -> str | None:
    name = signature.formals[position] if position < len(signature.formals) else None
    reporter.report(
        "XEI0304",
        f"an argument of `{signature.name}` has no name",
        arg.span,
        f"expected `{name}=` before it" if name else "there is no argument left for it",
        help=(f"arguments are named: `{signature.text}`",),
        fix=insert(arg.span, f"{name}=") if name else None,
    )
    return name


def _twice(name: str, arg: Arg, before: Arg, reporter: Reporter) -> None:
    reporter.report(
        "XEI0303",
        f"argument `{name}` is given twice",
        (arg.name or arg).span,
        "given again here",
        labels=(Label((before.name or before).span, "first given here"),),
        help=("keep one of the two",),
    )


def _missing(call: Call, signature: Signature, missing: tuple[str, ...], reporter: Reporter) -> None:
    s = "s" if len(missing) > 1 else ""
    reporter.report(
        "XEI0302",
        f"{signature.kind} `{signature.name}` needs the argument{s} {listed(missing)}",
        call.callee.span,
        f"{listed(missing)} missing",
        notes=(reporter.rule(signature.rule),) if signature.rule else (),
        help=(f"write `{signature.text}`",),
    )

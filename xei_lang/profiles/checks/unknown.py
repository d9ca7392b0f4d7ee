"""One way to say that a name is not known."""

from __future__ import annotations

from collections.abc import Sequence

from xei_lang.diagnostics import Diagnostic, Span, did_you_mean


def unknown(what: str, name: str, known: Sequence[str], span: Span, code: str = "XEI0620") -> Diagnostic:
    """`what` is the kind of thing that is looked for, with its article: `a skill of this profile`."""
    known = sorted(set(known))
    near = did_you_mean(name, known)
    shown = ", ".join(f"`{item}`" for item in known[:12]) + (" ..." if len(known) > 12 else "")
    help_ = f"did you mean `{near[0]}`?" if near else f"known are {shown}" if known else "there is none"
    return Diagnostic(code, f"`{name}` is not {what}", span, label=f"expected {what}", help=(help_,))

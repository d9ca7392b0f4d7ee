"""The parts of the checker, put together once for a protocol and its profile."""

from __future__ import annotations

from collections.abc import Mapping

from xei_lang.check.binding import Binder, CheckOptions
from xei_lang.check.budget import Budget
from xei_lang.check.calls import Calls
from xei_lang.check.constraints import Clauses
from xei_lang.check.evaluate import Evaluator
from xei_lang.check.given import Givens
from xei_lang.check.places import Places
from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter
from xei_lang.check.scope import Usage
from xei_lang.check.types import Types
from xei_lang.check.units import Unit, load_units
from xei_lang.diagnostics import Source, Span
from xei_lang.profiles.model import Profile
from xei_lang.record import Shown, record
from xei_lang.syntax.ast import Module, Name, Procedure


@record
class Context(Shown):
    """What every part of the expansion uses."""

    units: Mapping[str, Unit]
    options: CheckOptions
    registry: Registry
    reporter: Reporter
    usage: Usage
    types: Types
    evaluator: Evaluator
    calls: Calls
    clauses: Clauses
    givens: Givens
    binder: Binder

    def procedure(self, name: Name) -> Procedure | None:
        """The procedure that a name means in the file where it stands."""
        return self.units[name.span.file].procedures.get(name.id)

    def words(self, span: Span) -> str:
        """The words that a span covers."""
        return self.units[span.file].source.slice(span)


def make_context(module: Module, source: Source, profile: Profile, options: CheckOptions) -> Context:
    """The checker's parts for a file, what it imports, and a profile. Of two procedures of one name the first
    counts.
    """
    registry = Registry.of(profile)
    reporter = Reporter(options.sources)
    places = Places(reporter)
    budget = Budget(reporter)
    types = Types(registry, places, reporter, budget)
    evaluator = Evaluator(registry, places, reporter, budget)
    usage = Usage()
    units = load_units(module, source, options.files, reporter, usage, options.parse)
    budget.allow(sum(len(unit.source.text) for unit in units.values()))
    return Context(
        units,
        options,
        registry,
        reporter,
        usage,
        types,
        evaluator,
        Calls(registry, evaluator, types, reporter, units),
        Clauses(evaluator, types, reporter),
        Givens(evaluator, types, reporter),
        Binder(registry, evaluator, types, reporter, options),
    )

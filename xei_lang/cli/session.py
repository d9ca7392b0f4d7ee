"""One protocol on its way through the passes, with everything said shown as it is said."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from xei_lang.cli.exit_codes import INPUT_HAS_ERRORS
from xei_lang.cli.options import Options, WorldOptions
from xei_lang.cli.progress import Bar
from xei_lang.cli.report import exit_code, show
from xei_lang.diagnostics import Diagnostics, Source, Sources
from xei_lang.pipeline import FRONT, Handoffs, Pass, PassResult, Request, compile_request
from xei_lang.profiles.compiled import default_cache
from xei_lang.syntax.reading import read_source


@dataclass(frozen=True, slots=True, eq=False)
class Session:
    """A protocol that was read, what is asked of its compilation, and how to talk about it."""

    request: Request
    options: Options

    @property
    def source(self) -> Source:
        """The protocol's text."""
        return self.request.source

    @property
    def sources(self) -> Sources:
        """The texts that messages quote."""
        return {self.source.file: self.source}

    def show(self, diagnostics: Diagnostics) -> int:
        """Write diagnostics (errors only where that was asked for), and return their exit code."""
        chosen = tuple(item for item in diagnostics if not self.options.quiet or item.severity == "error")
        show(chosen, self.sources, self.options.color)
        return exit_code(diagnostics)

    def compile(self, passes: tuple[Pass, ...], watch: Callable[[PassResult], None]) -> Handoffs:
        """What the passes made. Exits with the right code where one of them has errors."""
        bar = Bar()
        request = self.request if self.options.quiet else replace(self.request, progress=bar)

        def seen(result: PassResult) -> None:
            bar.clear()
            self.show(result.diagnostics)
            watch(result)

        outcome = compile_request(request, passes, seen)
        if outcome.stopped_at is not None:
            sys.exit(exit_code(outcome.diagnostics) or INPUT_HAS_ERRORS)
        return outcome.made

    def grounded_by(self, world: WorldOptions) -> Session:
        """The same, with what the sources that `--world` names say of the world. Where the protocol's profile
        cannot be had, the passes will tell; exits where the source cannot be believed.
        """
        if not world.sources and world.picture is None:
            return self
        from xei_lang.cli.worlds import observed_by

        profile = compile_request(self.request, FRONT[:2]).made.profile
        if profile is None:
            return self
        observed, said = observed_by(world, profile, self.options.color)
        code = self.show(said)
        if code:
            sys.exit(code)
        return replace(self, request=replace(self.request, observed=observed))


def open_session(file: Path, options: Options, *, allow_unmapped: bool, strict: bool = False) -> Session:
    """Read a protocol. Exits with a diagnostic where it cannot be read."""
    source, problems = read_source(file, str(file))
    if source is None:
        show(problems, {}, options.color)
        sys.exit(exit_code(problems))
    return Session(request_for(source, options, allow_unmapped=allow_unmapped, strict=strict), options)


def request_for(source: Source, options: Options, *, allow_unmapped: bool, strict: bool = False) -> Request:
    """The compilation that the options ask for."""
    return Request(
        source,
        profile_folder=options.profile,
        cache=default_cache(),
        bindings=options.bindings,
        params=options.params,
        allow_unmapped=allow_unmapped,
        strict=strict,
        seed=options.seed,
    )

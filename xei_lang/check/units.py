"""The files of one check: the protocol's own and those that it imports, each with what it can call."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from xei_lang.check.report import Reporter
from xei_lang.check.scope import Scope, Usage
from xei_lang.diagnostics import Diagnostic, Diagnostics, Label, Source, has_errors
from xei_lang.record import Shown, record
from xei_lang.syntax.ast import Import, ImportTable, Module, Procedure
from xei_lang.syntax.loading import Files, LoadedFile, Unusable

Parse = Callable[[Source], tuple[Module | None, Diagnostics]]

MAX_FILES = 200
"""How many files one protocol may import, in all."""
MAX_IMPORT_DEPTH = 40


@record
class Unit(Shown):
    """One file. `procedures` are those that a call in it may name, its own and imported ones.

    `complete` says that there can be no others: every import of it could be read. `scope` holds its tables.
    """

    module: Module
    source: Source
    procedures: Mapping[str, Procedure]
    complete: bool
    scope: Scope

    @property
    def own(self) -> tuple[Procedure, ...]:
        """The procedures that stand in this file, in their order."""
        return tuple(item for item in self.module.items if isinstance(item, Procedure))


def load_units(
    module: Module,
    source: Source,
    files: Files | None,
    reporter: Reporter,
    usage: Usage,
    parse: Parse | None = None,
) -> Mapping[str, Unit]:
    """All units by the names of their files, the protocol's own first; a failed import is reported."""
    imports = any(isinstance(item, Import) for item in module.items)
    identity = files.identity(source.file) if files is not None and imports else source.file
    loading = _Loading(files, reporter, usage, parse)
    own = loading.unit(module, source, identity)
    return {source.file: own, **loading.units}


@dataclass(slots=True, eq=False)
class _Loading:
    """Goes through imports depth first; `chain` are the files and imports that led to where it is."""

    files: Files | None
    reporter: Reporter
    usage: Usage
    parse: Parse | None
    units: dict[str, Unit] = field(default_factory=dict[str, Unit])
    done: dict[str, Unit | None] = field(default_factory=dict[str, "Unit | None"])
    chain: list[tuple[str, Source, Import | None]] = field(
        default_factory=list[tuple[str, Source, "Import | None"]]
    )

    def unit(self, module: Module, source: Source, identity: str, node: Import | None = None) -> Unit:
        self.chain.append((identity, source, node))
        procedures = {item.name.id: item for item in reversed(module.items) if isinstance(item, Procedure)}
        complete = True
        for item in module.items:
            if isinstance(item, Import):
                found = self._import(source, item)
                complete = complete and found is not None
                for procedure in found.own if found is not None else ():
                    self._bring_in(procedure, item, procedures)
        self.chain.pop()
        return Unit(module, source, procedures, complete, Scope(self.usage))

    def _import(self, source: Source, node: Import) -> Unit | None:
        loaded = read(source, node, self.files, self.reporter)
        if loaded is None or self._circle(loaded, node):
            return None
        if loaded.identity not in self.done:
            if self._too_many(node):
                return None
            self.done[loaded.identity] = found = self._parsed(loaded, node)
            if found is not None:
                self.units[found.source.file] = found
        return self.done[loaded.identity]

    def _parsed(self, loaded: LoadedFile, node: Import) -> Unit | None:
        from xei_lang.syntax.parser import parse_module

        module, said = (self.parse or parse_module)(loaded.source)
        label = Label(node.path.span, "imported here")
        for item in said:
            self.reporter.keep(_with(item, label))
        if module is None or module.damaged:
            return None
        unit = self.unit(module, loaded.source, loaded.identity, node)
        if not unit.own and not has_errors(said):
            self.reporter.report(
                "XEI0122",
                f"`{node.path.value}` has no procedure to import",
                node.path.span,
                "expected a file with procedures",
                help=("only procedures can be imported; move what both need into one",),
            )
        return unit

    def _circle(self, loaded: LoadedFile, node: Import) -> bool:
        start = next((i for i, link in enumerate(self.chain) if link[0] == loaded.identity), None)
        if start is None:
            return False
        ring = self.chain[start:]
        names = [f"`{link[1].file}`" for link in ring]
        shown = " imports ".join((*names, names[0]))
        others = [link[2] for link in ring[1:] if link[2] is not None]
        self.reporter.report(
            "XEI0121",
            f"{names[0]} imports itself" if len(ring) == 1 else f"files import each other: {shown}",
            node.path.span,
            "this import closes the circle",
            labels=tuple(Label(other.path.span, "imported here") for other in others),
            help=("move the procedures that both need into a file that imports neither",),
        )
        return True

    def _too_many(self, node: Import) -> bool:
        if len(self.done) < MAX_FILES and len(self.chain) < MAX_IMPORT_DEPTH:
            return False
        self.reporter.report(
            "XEI0122",
            f"`{node.path.value}` is one file too many",
            node.path.span,
            f"a protocol may import {MAX_FILES} files, {MAX_IMPORT_DEPTH} deep",
        )
        return True

    def _bring_in(self, procedure: Procedure, node: Import, known: dict[str, Procedure]) -> None:
        before = known.setdefault(procedure.name.id, procedure)
        if before is procedure or before.span.file == procedure.span.file:
            return
        self.reporter.report(
            "XEI0209",
            f"this import brings in a second procedure `{procedure.name.id}`",
            node.path.span,
            f"`{procedure.name.id}` would have two meanings here",
            labels=(
                Label(procedure.name.span, "brought in by this import"),
                Label(before.name.span, "the other one"),
            ),
            help=("give one of the two another name",),
            about=procedure.name.id,
        )


def read(
    source: Source, node: Import | ImportTable, files: Files | None, reporter: Reporter
) -> LoadedFile | None:
    """The file that an import names; None where it cannot be had, which is reported."""
    path = node.path.value
    found = Unusable("cannot be read from here") if files is None else files.read(source.file, path)
    if isinstance(found, LoadedFile):
        return found
    reporter.report(
        "XEI0120" if found.outside else "XEI0122",
        f"`{path}` {found.reason}",
        node.path.span,
        "imports stay inside the project folder" if found.outside else "cannot be imported",
        help=found.help,
    )
    return None


def _with(diagnostic: Diagnostic, label: Label) -> Diagnostic:
    return replace(diagnostic, labels=(*diagnostic.labels, label))

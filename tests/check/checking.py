"""The small lab of these tests: a profile of its own, so that its lines stay where messages quote them."""

from __future__ import annotations

import posixpath
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from xei_lang.check import CheckOptions, check_module
from xei_lang.check.plan_file import check_plan, read_plan_text
from xei_lang.diagnostics import Diagnostics, Source, Sources
from xei_lang.diagnostics.options import option_source
from xei_lang.diagnostics.render.full import render_full
from xei_lang.ir.skill_plan import SkillPlan
from xei_lang.profiles.load import load_profile
from xei_lang.profiles.model import Profile
from xei_lang.syntax import Parser
from xei_lang.syntax.loading import LoadedFile, Unusable

ROOT = Path(__file__).parents[2]
LAB = Path(__file__).with_name("lab")
BENCH = ROOT / "profiles" / "openarm_bench"


@cache
def profile(folder: Path = LAB) -> Profile:
    loaded, diagnostics = load_profile(folder, None)
    assert loaded is not None, diagnostics
    return loaded


@cache
def parser() -> Parser:
    return Parser()


@cache
def profile_sources() -> Sources:
    files = {thing.span.file for thing in profile().objects} | {
        skill.span.file for skill in profile().bank.skills
    }
    return {file: Source(file, (LAB / Path(file).name).read_text(encoding="utf-8")) for file in sorted(files)}


@dataclass(frozen=True)
class Written:
    """Files that a test has written out, by their paths; see `split_files`."""

    texts: dict[str, str]

    def identity(self, file: str) -> str:
        return posixpath.normpath(file)

    def read(self, importing: str, path: str) -> LoadedFile | Unusable:
        joined = posixpath.normpath(posixpath.join(posixpath.dirname(importing), path))
        if joined.startswith(".."):
            return Unusable("lies outside of the project folder", True)
        text = self.texts.get(joined)
        return Unusable("does not exist") if text is None else LoadedFile(Source(joined, text), joined)


def split_files(text: str) -> tuple[str, dict[str, str]]:
    """The protocol, and the files that follow it, each after a line `# file: its/path`."""
    first, *others = re.split(r"^# file: (\S+)\n", text, flags=re.MULTILINE)
    return first, dict(zip(others[::2], others[1::2], strict=True))


def check(text: str, folder: Path = LAB, **options: object) -> tuple[SkillPlan | None, Diagnostics]:
    """Check a text with options as CheckOptions has them; it must parse. Files that it imports may follow."""
    text, others = split_files(text)
    source = Source("t.xei", text)
    module, diagnostics = parser().module(source)
    assert module is not None, render_full(diagnostics, {"t.xei": source})
    given = CheckOptions(sources=profile_sources(), files=Written({**others, "t.xei": text}), **options)  # type: ignore[arg-type]
    return check_module(module, source, profile(folder), given)


def plan_of(text: str, folder: Path = LAB, **options: object) -> SkillPlan:
    """The plan of a text that must have no errors."""
    plan, diagnostics = check(text, folder, **options)
    assert plan is not None, rendered(text, diagnostics)
    return plan


def rendered(text: str, diagnostics: Diagnostics) -> str:
    main, others = split_files(text)
    known = {name: Source(name, body) for name, body in {**others, "t.xei": main}.items()}
    spans = [item.span for found in diagnostics for item in (found, *found.labels) if item.span is not None]
    options = [option_source(span.file) for span in spans]
    return render_full(diagnostics, known | {source.file: source for source in options if source is not None})


def check_json(text: str, folder: Path = LAB) -> tuple[SkillPlan | None, Diagnostics]:
    """Check the text of a plan that came from elsewhere."""
    source = Source("plan.json", text)
    read, said = read_plan_text(source)
    if read is None:
        return None, said
    plan, found = check_plan(read, source, profile(folder), profile_sources())
    return (None if said else plan), (*said, *found)


def rendered_plan(text: str) -> str:
    """What is said of the text of a plan."""
    return render_full(check_json(text)[1], {"plan.json": Source("plan.json", text)})


def protocol(body: str) -> str:
    """A protocol around statements."""
    return f'protocol p {{\n  profile "lab"\n{body}\n}}\n'


def codes(body: str, **options: object) -> list[str]:
    """The codes that a protocol with this body gives, in order."""
    return [diagnostic.code for diagnostic in check(protocol(body), **options)[1]]


def ids(body: str, **options: object) -> list[str]:
    """The step ids of a protocol with this body, which must have no errors."""
    return [step.step_id for step in plan_of(protocol(body), **options).steps]

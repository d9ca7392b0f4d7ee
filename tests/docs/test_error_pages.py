"""Every code has a page, and what the page shows is so: the example gives that code only, the fix none."""

from __future__ import annotations

import shlex
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest

from tests.docs.error_pages import BENCH, FOLDER, PLAN, Page, Section, read_page
from xei_lang.check.plan_file.check import check_plan, read_plan_text
from xei_lang.cli.worlds import observed_in
from xei_lang.diagnostics import CATALOGUE, Diagnostics, Source, has_errors
from xei_lang.diagnostics.render.full import render_full
from xei_lang.doctor import deployment_blockers, deployment_warnings
from xei_lang.pipeline import ALL, FRONT, Request, compile_request
from xei_lang.profiles.load import load_profile

FILES = sorted(FOLDER.glob("*.md"))
PAGES = [read_page(file) for file in FILES]
RUN = [page for page in PAGES if page.is_run]
TO_GOALS = ALL[: [step.adds for step in ALL].index("graph") + 1]
NOT_REACHED = {
    "XEI0101", "XEI0102", "XEI0107", "XEI0109", "XEI0125", "XEI0204", "XEI0321",
    "XEI0632", "XEI0662", "XEI0667", "XEI0668",
    "XEI0680", "XEI0681", "XEI0682", "XEI0683", "XEI0684", "XEI0685", "XEI0686", "XEI0687", "XEI0688",
    "XEI0690", "XEI0691", "XEI0692", "XEI0693", "XEI0694",
    "XEI0695", "XEI0696", "XEI0697", "XEI0698", "XEI0699",
    "XEI0705", "XEI0711", "XEI0715",
}  # fmt: skip
"""Codes before the motion whose example is no protocol on this bench: each page says why."""


def test_every_code_has_a_page() -> None:
    assert [file.stem for file in FILES] == sorted(CATALOGUE)


def test_pages_have_the_titles_of_the_catalogue() -> None:
    for file, page in zip(FILES, PAGES, strict=True):
        assert (file.stem, CATALOGUE[file.stem].title) == (page.code, page.title)


def test_related_codes_exist() -> None:
    for page in PAGES:
        assert page.code not in page.related
        assert set(page.related) <= CATALOGUE.keys(), page.code


def test_all_examples_before_motion_are_run() -> None:
    not_run = {page.code for page in PAGES if not page.is_run and page.code < "XEI0800"}
    assert not_run == NOT_REACHED
    for page in RUN:
        shown = page.section("Example")
        assert shown.changes or shown.files, page.code


@pytest.mark.parametrize("page", RUN, ids=lambda page: page.code)
def test_the_example_gives_its_code_and_no_other(
    page: Page, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert _only_codes(_codes(page, page.section("Example"), tmp_path, monkeypatch)) == {page.code}


@pytest.mark.parametrize("page", RUN, ids=lambda page: page.code)
def test_the_fix_gives_none(page: Page, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fix = page.section("Fix")
    assert fix.changes or fix.files or fix.profile_lines
    assert _codes(page, fix, tmp_path, monkeypatch) == set()
    stated = [path for path in sorted(BENCH.rglob("*.*")) if path.suffix not in (".py", ".pyc")]
    bench = [path.read_text(encoding="utf-8") for path in stated]
    for lines in fix.profile_lines:
        assert any(lines in text for text in bench), f"the bench does not hold\n{lines}"


def _only_codes(found: set[str]) -> set[str]:
    return {item.split()[0] for item in found}


def _blockers(profile: Path) -> set[str]:
    """What blocks a profile: each code with the item that it is about; and what `xei doctor` warns of."""
    loaded, said = load_profile(profile, None)
    assert loaded is not None, said
    warned = {f"{warning.code} {warning.message}" for warning in deployment_warnings(loaded)}
    return {f"{blocker.code} {blocker.item}" for blocker in deployment_blockers(loaded)} | warned


def _codes(page: Page, section: Section, folder: Path, monkeypatch: pytest.MonkeyPatch) -> set[str]:
    """The codes that are said. A first line `# xei compile FILE OPTIONS` compiles, as lowering does."""
    path = section.write(folder)
    monkeypatch.chdir(folder)
    if page.is_of_doctor:
        return _blockers(folder / "profiles" / BENCH.name) - _blockers(BENCH)
    text = path.read_text(encoding="utf-8")
    if path.name == PLAN:
        return {item.code for item in _of_plan(Source(path.name, text), folder / "profiles" / BENCH.name)}
    first = text.partition("\n")[0]
    words = shlex.split(first.removeprefix("# ")) if first.startswith("# xei ") else []
    compiles = words[1:2] == ["compile"] or page.code >= "XEI06"
    bindings = tuple(
        (name, value)
        for flag, pair in pairwise(words)
        if flag == "--bind"
        for name, _, value in [pair.partition("=")]
    )
    source = Source(path.name, text)
    request = Request(source, bindings=bindings, open_bindings=not compiles, strict="--strict" in words)
    observed, said = (), ()
    if "--world" in words:
        profile = compile_request(request, FRONT[:2]).made.profile
        assert profile is not None
        observed, said = observed_in(words[words.index("--world") + 1], profile)
    if not has_errors(said):
        request = replace(request, observed=observed)
        said = (*said, *compile_request(request, TO_GOALS if compiles else FRONT).diagnostics)
    return {item.code for item in _told(said, page, source)}


def _of_plan(source: Source, profile: Path) -> Diagnostics:
    """What is said of a plan that came from elsewhere."""
    loaded, said = load_profile(profile, None)
    assert loaded is not None, said
    read, found = read_plan_text(source)
    if read is not None:
        found = (*found, *check_plan(read, source, loaded, {})[1])
    print(render_full(found, {source.file: source}))
    return found


def _told(said: Diagnostics, page: Page, source: Source) -> Diagnostics:
    """All but what is so of the bench whatever the protocol, on pages that are about something else."""
    aside = {"XEI0660", "XEI0504", "XEI0717"} - {page.code}
    told = tuple(item for item in said if item.code not in aside)
    print(render_full(told, {source.file: source}))
    return told

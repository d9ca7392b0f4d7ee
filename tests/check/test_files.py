"""Imports: what they bring in, what they hide, and which files they may name."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.check.checking import check, plan_of, protocol
from xei_lang.ir.verify_plan import verify_plan
from xei_lang.syntax.loading import LoadedFile, Unusable
from xei_lang.syntax.project import ProjectFiles, project_folder

FILL = """
# file: lib/fill.xei
import "pour.xei"
procedure fill(tube: liquid_container) { take: pick(object=cup_1)  pour_once(tube=tube) }
# file: lib/pour.xei
procedure pour_once(tube: liquid_container) { pour(source=cup_1, target=tube, volume=1 mL) }
"""


def test_imported_procedures_are_inlined_as_those_of_the_file() -> None:
    plan = plan_of(f'import "lib/fill.xei"\n{protocol("one: fill(tube=tube_1)")}{FILL}')
    assert [step.step_id for step in plan.steps] == ["one.take", "one.pour_once#1.pour#1"]
    assert [call.procedure for call in plan.steps[1].origin] == ["fill", "pour_once"]
    assert [call.span.file for call in plan.steps[1].origin] == ["t.xei", "lib/fill.xei"]
    assert verify_plan(plan) == ()


def test_a_file_sees_only_what_it_imports_itself() -> None:
    found = check(f'import "lib/fill.xei"\n{protocol("pour_once(tube=tube_1)")}{FILL}')[1]
    assert [item.code for item in found] == ["XEI0201"]


def test_procedures_of_one_name_in_two_files_may_call_each_other() -> None:
    files = (
        '# file: a.xei\nimport "b.xei"\nprocedure q() { p() }\n# file: b.xei\nprocedure p() { wait 1 s }\n'
    )
    plan = plan_of(f'import "a.xei"\nprocedure p() {{ q() }}\n{protocol("p()")}{files}')
    assert [step.step_id for step in plan.steps] == ["p#1.q#1.p#1.wait#1"]


def test_a_file_that_two_others_import_is_read_once() -> None:
    files = (
        '# file: a.xei\nimport "c.xei"\nprocedure a() { c() }\n# file: b.xei\nimport "c.xei"\n'
        "procedure b() { c() }\n# file: c.xei\nprocedure c() { wait 1 s }\n"
    )
    text = f'import "a.xei"\nimport "b.xei"\nimport "c.xei"\n{protocol("a() b() c()")}{files}'
    assert [step.step_id for step in plan_of(text).steps] == [
        "a#1.c#1.wait#1",
        "b#1.c#1.wait#1",
        "c#1.wait#1",
    ]


def test_the_text_of_an_imported_file_is_parsed_and_its_mistakes_name_the_import() -> None:
    plan, found = check(f'import "bad.xei"\n{protocol("late()")}\n# file: bad.xei\nprocedure late( {{ }}\n')
    assert plan is None
    assert {item.span.file for item in found if item.span} == {"bad.xei"}
    assert [label.span.file for label in found[0].labels][-1:] == ["t.xei"]


def test_a_long_chain_of_imports_ends_in_a_message() -> None:
    files = "".join(
        f'# file: f{n}.xei\nimport "f{n + 1}.xei"\nprocedure p{n}() {{ wait 1 s }}\n' for n in range(300)
    )
    found = check(f'import "f0.xei"\n{protocol("p0()")}{files}')[1]
    assert [item.code for item in found] == ["XEI0122"]


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project with a protocol, a library, and things that lie outside of it."""
    root = tmp_path / "project"
    (root / "protocols" / "lib").mkdir(parents=True)
    (root / "profiles").mkdir()
    for file in ("protocols/run.xei", "protocols/lib/caps.xei", "shared.xei"):
        (root / file).write_text("procedure p() { wait 1 s }\n", encoding="utf-8")
    (tmp_path / "secret.xei").write_text("procedure s() { wait 1 s }\n", encoding="utf-8")
    (root / "protocols" / "link.xei").symlink_to(tmp_path / "secret.xei")
    (root / "protocols" / "out").symlink_to(tmp_path)
    (root / "protocols" / "twin.xei").symlink_to(root / "shared.xei")
    (root / "protocols" / "latin.xei").write_bytes(b"# \xe9\n")
    return root


def reading(project: Path, path: str) -> LoadedFile | Unusable:
    run = project / "protocols" / "run.xei"
    return ProjectFiles(run).read(str(run), path)


@pytest.mark.parametrize("path", ["lib/caps.xei", "./lib/../lib/caps.xei", "../shared.xei", "twin.xei"])
def test_files_of_the_project_can_be_read(project: Path, path: str) -> None:
    found = reading(project, path)
    assert isinstance(found, LoadedFile)
    assert found.source.text.startswith("procedure")
    assert found.source.file == str((project / "protocols" / path).parent.resolve() / Path(path).name)


@pytest.mark.parametrize(
    "path",
    ["../../secret.xei", "/etc/passwd", "~/x.xei", "C:/x.xei", "link.xei", "out/secret.xei",
     "lib/../../../secret.xei"],
)  # fmt: skip
def test_nothing_outside_of_the_project_is_read(project: Path, path: str) -> None:
    found = reading(project, path)
    assert isinstance(found, Unusable)
    assert found.outside


@pytest.mark.parametrize(
    ("path", "reason"),
    [
        ("lib", "is a folder, not a file"),
        ("lib/cpas.xei", "does not exist"),
        ("latin.xei", "is not UTF-8 text"),
        ("lib\\caps.xei", "has a backslash in it"),
        ("", "is no path"),
        ("a\x00b.xei", "is no path"),
        ("\x1b[2Jx.xei", "is no path"),
    ],
)
def test_what_cannot_be_read_says_why(project: Path, path: str, reason: str) -> None:
    found = reading(project, path)
    assert isinstance(found, Unusable)
    assert (found.reason, found.outside) == (reason, False)


def test_a_misspelt_file_is_guessed(project: Path) -> None:
    for path in ("lib/cpas.xei", "lib/caps"):
        found = reading(project, path)
        assert isinstance(found, Unusable)
        assert found.help == ("did you mean `lib/caps.xei`?",)


def test_two_names_of_one_file_are_one_file(project: Path) -> None:
    found = [reading(project, path) for path in ("twin.xei", "../shared.xei")]
    assert len({item.identity for item in found if isinstance(item, LoadedFile)}) == 1


def test_the_project_folder_is_the_nearest_with_a_mark(project: Path) -> None:
    assert project_folder(project / "protocols" / "run.xei") == project.resolve()
    assert project_folder(project.parent / "secret.xei") == project.parent.resolve()

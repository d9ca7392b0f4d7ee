"""The forms in which a compilation can be written: one representation, or the whole bundle."""

from __future__ import annotations

import time
from pathlib import Path

import click

from xei_lang.cli.handoff_lines import line
from xei_lang.diagnostics import Diagnostics, Source
from xei_lang.pipeline import ALL, FRONT, Handoffs, Pass, PassResult, Request

EMITTED = ("ast", "plan", "goals", "dot", "timed", "bag")


def passes_for(stage: str | None) -> tuple[Pass, ...]:
    """The passes that a representation needs; the whole way where a bundle is asked for."""
    if stage == "ast":
        return FRONT[:1]
    if stage == "plan":
        return FRONT
    if stage in ("goals", "dot"):
        return ALL[: [step.adds for step in ALL].index("graph") + 1]
    return ALL


def text_of(stage: str, request: Request, made: Handoffs) -> str:
    """The fixed form of a representation (docs/cli.md)."""
    if stage == "ast":
        from xei_lang.syntax import dump

        assert made.module is not None
        return dump.to_text(made.module, request.source)
    from xei_lang.ir.forms import goals_json, plan_json, timed_json
    from xei_lang.ir.forms.canonical import dumps

    if stage == "plan":
        assert made.plan is not None
        return dumps(plan_json.to_json(made.plan, {request.source.file: request.source}))
    assert made.graph is not None
    if stage == "goals":
        return dumps(goals_json.to_json(made.graph))
    if stage == "dot":
        from xei_lang.export.dot import to_dot

        return to_dot(made.graph)
    assert made.timed is not None
    return dumps(timed_json.to_json(made.timed))


def text_after(result: PassResult, source: Source) -> str:
    """What a pass made, for people."""
    made = result.made
    if result.pass_name == "parse" and made.module is not None:
        from xei_lang.syntax import dump

        return dump.to_text(made.module, source)
    if result.pass_name in ("check", "admit") and made.plan is not None:
        from xei_lang.ir.forms import plan_text

        return plan_text.to_text(made.plan)
    if result.pass_name == "ground" and made.world is not None:
        from xei_lang.ir.forms import world_text

        return world_text.to_text(made.world)
    if result.pass_name == "lower" and made.graph is not None:
        from xei_lang.ir.forms import goals_text

        return goals_text.to_text(made.graph)
    if made.timed is not None:
        from xei_lang.ir.forms import timed_text

        return timed_text.to_text(made.timed)
    return f"profile {made.profile.name}\n" if made.profile is not None else ""


def write_all(stage: str | None, target: Path, request: Request, made: Handoffs, quiet: bool) -> Diagnostics:
    """Write the bundle, or for `bag` only its recording, into a folder, and say so in one line."""
    from xei_lang.cli.deliver import Compiled
    from xei_lang.export.bundle import write_bundle

    started = time.perf_counter()
    compiled = Compiled.of(request.source, made, request.observed)
    contents = compiled.bundle_contents()
    if stage == "bag":
        contents = {name: content for name, content in contents.items() if name == "rosbag"}
    problems = write_bundle(target, contents, compiled.manifest(request.seed))
    if not quiet and not problems:
        files = [path for path in target.rglob("*") if path.is_file()]
        size = sum(path.stat().st_size for path in files) / 1e6
        content = f"{target}: {len(files)} files, {size:.1f} MB"
        click.echo(line("bundle", "", content, time.perf_counter() - started), err=True)
    return problems

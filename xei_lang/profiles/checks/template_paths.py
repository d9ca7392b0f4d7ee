"""Whether a `move_to` states its path whole, and nothing that its path does not have (XEI0623)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType

from xei_lang.diagnostics import Diagnostic
from xei_lang.profiles.model import SkillSpec, TemplateStep
from xei_lang.profiles.trees import Trees

PATH_FIELDS = ("axis", "angle", "lead", "area", "pitch")
STATED: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {"arc": ("axis", "angle"), "screw": ("axis", "angle", "lead"), "raster": ("area", "pitch")}
)
"""The fields that a stated path has, by its kind; a free or straight one has none of them."""


def check_path(skill: SkillSpec, line: TemplateStep, trees: Trees) -> Iterator[Diagnostic]:
    """Fields that the line's kind of path lacks, or that it does not have; a target without its tool."""
    if line.kind != "move_to" or line.field("at") is None:
        return
    path = str(line.field("path") or "free")
    wanted = STATED.get(path, ())
    where = f"in the template of `{skill.name}`"
    if line.field("tool") is None:
        message = f"`move_to` {where} goes to a point with no tool"
        yield Diagnostic("XEI0623", message, line.span, label="expected `tool`", help=("add `tool: arm`",))
    for name in PATH_FIELDS:
        has = line.field(name) is not None
        if has and name not in wanted:
            paths = " or ".join(f"`path: {kind}`" for kind, fields in STATED.items() if name in fields)
            yield Diagnostic(
                "XEI0623",
                f"`path: {path}` {where} has no `{name}`",
                trees.of_skill(skill.name, "template", *line.path, line.kind, name),
                label=f"expected only with {paths}",
                help=(f"take `{name}` out, or write {paths}",),
            )
        elif name in wanted and not has:
            yield Diagnostic(
                "XEI0623",
                f"`path: {path}` {where} needs `{name}`",
                trees.of_skill(skill.name, "template", *line.path, line.kind, "path"),
                label=f"expected {', '.join(f'`{item}`' for item in wanted)}",
                help=(f"add `{name}: ...`",),
            )

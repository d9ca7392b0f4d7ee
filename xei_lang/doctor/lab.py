"""Objects that lack what perception needs, and skills that no object of the lab can take part in."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import PurePosixPath

from xei_lang.check.roles import fits
from xei_lang.diagnostics import Span
from xei_lang.doctor.blocker import Blocker
from xei_lang.profiles.model import LabObject, Profile

USAGE = "usage_profile"
BANK = "development_profile"


def lab_blockers(profile: Profile) -> Iterator[Blocker]:
    """Objects without a place, missing assets, and skills with an argument whose roles no object has."""
    files = dict(profile.files)
    for item in profile.objects:
        if item.prior is None:
            yield _unplaced(item)
        for asset, path in item.assets:
            if not item.system and path not in files:
                yield _asset(item, asset, path)
    for skill in profile.bank.skills:
        for arg in skill.args:
            roles = arg.roles if arg.type == "object" and arg.required else None
            if roles is not None and not any(fits(roles, item.roles) for item in profile.objects):
                measure = (
                    f"give an object the roles `{arg.roles_text}`, or take `{skill.name}` out of the bank"
                )
                item = f"skills.{skill.name}.args.{arg.name}"
                yield Blocker(
                    "XEI0674", BANK, item, "unusable", "hardware", measure, _file(arg.span, item), arg.span
                )


def _unplaced(item: LabObject) -> Blocker:
    where = f"objects.{item.name}.prior"
    measure = f"say where `{item.name}` is believed to stand, or ground the world from a source that finds it"
    return Blocker(
        "XEI0673", USAGE, where, "missing", "simulate", measure, _file(item.span, where), item.span
    )


def _asset(item: LabObject, asset: str, path: str | None) -> Blocker:
    where = f"objects.{item.name}.assets.{asset}"
    kinds = "STL, OBJ or PLY" if asset == "mesh" else "PLY, PCD or XYZ"
    measure = f"scan `{item.name}` or export it from its drawing, and name the file ({kinds}) with its unit"
    if path is not None:
        measure = f"put the file where the profile has it: there is no `{path}`"
    return Blocker(
        "XEI0672", USAGE, where, "missing", "hardware", measure, _file(item.span, where), item.span
    )


def _file(span: Span, item: str) -> str:
    return f"{PurePosixPath(span.file).name}:{item}"

"""`xei schema`: the JSON Schema of each form that other programs may rely on."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

import click

from xei_lang.diagnostics import did_you_mean

_PACKAGE = Path(__file__).resolve().parents[1]

FORMS: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "check": ("diagnostics/render/check.schema.json", "what `xei check --format json` prints"),
        "plan": ("ir/forms/plan.schema.json", "`plan.json`: the steps of a protocol as skill calls"),
        "goals": ("ir/forms/goals.schema.json", "`goals.json`: what is to move, with all parameters"),
        "timed": ("ir/forms/timed.schema.json", "`timed.json`: joints over time"),
        "scene": ("export/scene.schema.json", "`scene.json`: the bodies before anything moves"),
        "manifest": ("export/manifest.schema.json", "`manifest.json`: what a bundle was made from"),
        "doctor": ("doctor/doctor.schema.json", "what `xei doctor --format json` prints"),
        "trace": ("ir/forms/trace.schema.json", "a line of what `xei run --trace` writes"),
        "world": ("world/view/world.schema.json", "what `xei world show --format json` prints"),
        "scene_file": ("world/sources/scene_file.schema.json", "a recorded scene, as `--world` reads it"),
        "scans": ("world/map/scans.schema.json", "a line of what `xei map build` reads"),
        "recording": ("world/calibration/recording.schema.json", "what `xei calibrate` reads"),
        "tags": ("world/perception/tags.schema.json", "what `xei perception detect --format json` prints"),
        "pose_request": ("world/perception/pose_request.schema.json", "what a pose service is asked"),
        "pose_response": ("world/perception/pose_response.schema.json", "what a pose service answers"),
    }
)
"""Forms whose schema is a file of the package, and what they are."""

PROFILES: Mapping[str, str] = MappingProxyType(
    {
        "usage_profile": "`usage_profile.yaml`: what is in the lab",
        "calibration_profile": "`calibration_profile.yaml`: where everything stands, and limits",
        "development_profile": "`development_profile.yaml`: the skill bank",
        "object_registry": "`object_registry.yaml`: what belongs to the room",
    }
)
"""Files of a profile, whose schema is made from their models."""


@click.command("schema")
@click.argument("name", required=False)
@click.option("--quiet", is_flag=True, help="Print what was asked for only; it is never more.")
def command(*, name: str | None, quiet: bool) -> None:
    """Print the JSON Schema of a form that other programs may rely on.

    Without a name, all forms are listed.

    Example: xei schema plan
    """
    if name is None:
        listed = {**{form: about for form, (_, about) in FORMS.items()}, **PROFILES}
        click.echo("\n".join(f"{form:<20} {about}" for form, about in listed.items()))
    elif name in FORMS:
        click.echo((_PACKAGE / FORMS[name][0]).read_text(encoding="utf-8"), nl=False)
    elif name in PROFILES:
        import json

        from xei_lang.profiles.schema_json import profile_schema

        click.echo(json.dumps(profile_schema(name), indent=2, ensure_ascii=False))
    else:
        near = did_you_mean(name, (*FORMS, *PROFILES))
        hint = f"did you mean `{near[0]}`?" if near else "`xei schema` lists all forms"
        raise click.BadParameter(f"there is no form `{name}`; {hint}", param_hint="NAME")

"""A profile folder, read and validated: YAML with places, pydantic, dataclasses, cross checks."""

from __future__ import annotations

from typing import TypeVar

from pydantic import ValidationError

from xei_lang.diagnostics import Diagnostic, Diagnostics, Source, Span, has_errors
from xei_lang.profiles.build_assets import AssetReader
from xei_lang.profiles.build_bank import build_bank
from xei_lang.profiles.build_calibration import build_calibration
from xei_lang.profiles.build_objects import build_object
from xei_lang.profiles.faults import explain
from xei_lang.profiles.files import CALIBRATION, DEVELOPMENT, REGISTRY, ProfileFiles, read_text
from xei_lang.profiles.model import LabObject, Profile
from xei_lang.profiles.robot import read_robot
from xei_lang.profiles.schema.calibration import CalibrationProfile
from xei_lang.profiles.schema.development import DevelopmentProfile
from xei_lang.profiles.schema.registry import ObjectRegistry
from xei_lang.profiles.schema.usage import ObjectModel, UsageProfile
from xei_lang.profiles.schema.values import Model
from xei_lang.profiles.trees import Trees
from xei_lang.profiles.yaml_reader import read_yaml
from xei_lang.profiles.yaml_tree import Node

_M = TypeVar("_M", bound=Model)


def build_profile(files: ProfileFiles) -> tuple[Profile | None, Diagnostics]:
    """The profile of a folder; None where anything is wrong. Faults of all files come from one run."""
    found: list[Diagnostic] = []
    registry = _read(files, REGISTRY, ObjectRegistry, found)
    usage = None
    if registry:
        named_at = registry[1].span_of("usage_profile")
        usage = _read(files, registry[0].usage_profile, UsageProfile, found, named_at)
    development = _read(files, DEVELOPMENT, DevelopmentProfile, found)
    calibration = _read(files, CALIBRATION, CalibrationProfile, found)
    if not (registry and usage and development and calibration):
        return None, tuple(found)
    bank = build_bank(development[0], development[1], development[2].text, found)
    urdf = read_text(files, bank.urdf, found, development[1].span_of("robot", "urdf"))
    srdf = read_text(files, bank.srdf, found, development[1].span_of("robot", "srdf"))
    if urdf is None or srdf is None:
        return None, tuple(found)
    robot, faults = read_robot(urdf, srdf)
    found.extend(faults)
    if robot is None:
        return None, tuple(found)
    reader = AssetReader(files)
    objects = (
        *_objects(usage[0].objects, usage[1], "objects", reader, found),
        *_objects(registry[0].system_objects, registry[1], "system_objects", reader, found),
    )
    profile = Profile(
        name=files.folder.resolve().name,
        folder=files.shown,
        objects=tuple(sorted(objects, key=lambda item: item.name)),
        bank=bank,
        calibration=build_calibration(calibration[0], robot, calibration[1], found),
        incompatible=_incompatible(usage[0], usage[1], found),
        files=files.hashes,
        robot=robot,
        hazards=tuple((name, tuple(liquid.hazards)) for name, liquid in usage[0].liquids.items()),
    )
    if not has_errors(tuple(found)):
        from xei_lang.profiles.checks import check_profile

        found.extend(check_profile(profile, Trees(usage[1], registry[1], development[1], calibration[1])))
    return (None if has_errors(tuple(found)) else profile), tuple(found)


def _read(
    files: ProfileFiles,
    name: str,
    model: type[_M],
    found: list[Diagnostic],
    named_at: Span | None = None,
) -> tuple[_M, Node, Source] | None:
    """One YAML file as a validated model, its tree and its text; None with diagnostics."""
    source = read_text(files, name, found, named_at)
    if source is None:
        return None
    root, faults = read_yaml(source.file, source.text)
    found.extend(faults)
    if root is None:
        return None
    try:
        return model.model_validate(root.plain()), root, source
    except ValidationError as error:
        told = {fault.span for fault in faults}
        found.extend(fault for fault in explain(error, root, model) if fault.span not in told)
        return None


def _objects(
    models: dict[str, ObjectModel], root: Node, section: str, reader: AssetReader, found: list[Diagnostic]
) -> tuple[LabObject, ...]:
    system = section == "system_objects"
    built = (
        build_object(model, root, (section, name), reader, system=system, found=found)
        for name, model in models.items()
    )
    return tuple(item for item in built if item is not None)


def _incompatible(usage: UsageProfile, root: Node, found: list[Diagnostic]) -> tuple[tuple[str, str], ...]:
    pairs: list[tuple[str, str]] = []
    for index, pair in enumerate(usage.incompatible):
        if len(pair) != 2:
            found.append(
                Diagnostic(
                    "XEI0609",
                    "what must not meet is written as pairs",
                    root.span_of("incompatible", index),
                    label=f"expected 2 names, found {len(pair)}",
                )
            )
        else:
            pairs.append((pair[0], pair[1]))
    return tuple(pairs)

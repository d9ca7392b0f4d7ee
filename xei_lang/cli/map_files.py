"""A map that was built, as files and in the calibration profile; nothing of another map is lost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from xei_lang.cli.calibration_file import calibration_path, rewrite_calibration
from xei_lang.cli.report import show
from xei_lang.cli.write_file import write_bytes
from xei_lang.diagnostics import Diagnostic, Diagnostics
from xei_lang.profiles.load import load_profile
from xei_lang.profiles.model import Profile

if TYPE_CHECKING:
    from xei_lang.world.map.grid import OccupancyGrid


@dataclass(frozen=True, slots=True)
class Target:
    """Where a map goes: its folder and name, and with `write` the section `map` of the profile, too."""

    lab: Profile
    folder: Path
    name: str
    write: bool
    quiet: bool
    colored: bool

    @property
    def is_inside(self) -> bool:
        """Whether the folder is one of the profile, or the profile's own."""
        return self.folder.resolve().is_relative_to(Path(self.lab.folder).resolve())

    @property
    def below(self) -> str:
        """The folder as the profile names it; `map` for one that the files are still to be copied from."""
        if not self.is_inside:
            return "map"
        below = self.folder.resolve().relative_to(Path(self.lab.folder).resolve()).as_posix()
        return "" if below == "." else below


def deliver(grid: OccupancyGrid, recorded_on: str, target: Target) -> Diagnostics:
    """Write the two files and print the profile's section, or put it in its place and check the drives."""
    from xei_lang.profiles.map_files import map_sha256
    from xei_lang.world.map.write_map import image_bytes, profile_lines, section_values, yaml_text

    yaml, image = yaml_text(grid, f"{target.name}.pgm"), image_bytes(grid)
    files = {
        target.folder / f"{target.name}.pgm": image,
        target.folder / f"{target.name}.yaml": yaml.encode(),
    }
    said = _other_maps(files)
    for path, data in files.items():
        said = said or write_bytes(path, data)
    if said:
        return said
    sha256 = map_sha256(yaml.encode(), image)
    frame = target.lab.calibration.map_frame
    values = section_values(frame, target.below, target.name, sha256, recorded_on)
    if not target.write:
        click.echo(profile_lines(values), nl=False)
        return ()
    return _put_in(target, values) or _looked_at(target)


def _other_maps(files: dict[Path, bytes]) -> Diagnostics:
    """XEI0668 for the first file that stands there and holds something else."""
    from xei_lang.profiles.map_files import read_limited

    for path, data in files.items():
        if path.is_file() and read_limited(path, max(len(data), 1)) != data:
            message = f"`{path}` is there, and is another map"
            note = "stations and drives may rest on that map, and the profile knows it by its hash"
            return (Diagnostic("XEI0668", message, notes=(note,), help=("give this one another `--name`",)),)
    return ()


def _put_in(target: Target, values: Mapping[str, str]) -> Diagnostics:
    from xei_lang.world.map.write_map import put_in

    changed, problems = rewrite_calibration(target.lab, lambda source: put_in(source, values))
    if not problems and not target.quiet:
        named = target.lab.calibration.map
        had = named is not None and named.is_named and changed
        told = f"; `{named.yaml}` is in its history" if named is not None and had else ""
        click.echo(f"`map` of {calibration_path(target.lab)} names {values['yaml']}{told}", err=True)
    return problems


def _looked_at(target: Target) -> Diagnostics:
    """What the map says against the stations and the drives between them: warnings, for a map is as it is."""
    from xei_lang.world.ground import ground
    from xei_lang.world.map.deployed import look_at_map

    lab, said = load_profile(Path(target.lab.folder), None)
    world = ground(lab)[0] if lab is not None else None
    if lab is None or world is None:
        return said
    seen = look_at_map(lab, world)
    if not target.quiet:
        show(seen.diagnostics, {}, target.colored)
    if seen.floor is not None and not target.quiet:
        from xei_lang.world.map.picture import summary

        click.echo(summary(lab, world, seen, seen.floor), nl=False, err=True)
    return ()

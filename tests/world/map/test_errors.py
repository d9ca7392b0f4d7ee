"""What is said of bad maps and recordings, as people see it."""

from __future__ import annotations

import itertools
from pathlib import Path

from tests.world.bench import bench
from tests.world.map.lab import loaded, mapped_lab, room
from xei_lang.diagnostics import Diagnostics, Source
from xei_lang.diagnostics.render.full import render_full
from xei_lang.profiles.sources import folder_sources
from xei_lang.world.ground import ground
from xei_lang.world.map.deployed import look_at_map
from xei_lang.world.map.grid import OccupancyGrid
from xei_lang.world.map.read_map import read_grid, read_meta
from xei_lang.world.map.recording import read_scans


def of_yaml(text: str) -> str:
    source = Source("lab.yaml", text)
    meta, said = read_meta(source)
    if meta is not None:
        grid = read_grid(meta, source, "lab.pgm", b"a photograph of the lab")
        assert not isinstance(grid, OccupancyGrid)
        said = (grid,)
    return render_full(said, {source.file: source})


def of_profile(folder: Path, section: str) -> str:
    """`section` is a key of the profile's `map` with another value; `map/other.pgm` is there."""
    lab = mapped_lab(folder, room())
    (lab / "map" / "other.pgm").write_bytes((lab / "map" / "lab.pgm").read_bytes())
    file = lab / "calibration_profile.yaml"
    key = section.splitlines()[1].partition(":")[0]
    lines = file.read_text(encoding="utf-8").split("\n")
    start = lines.index("map:")
    at = next(k for k in range(start, len(lines)) if lines[k].startswith(f"{key}:"))
    lines[at] = section.splitlines()[1]
    file.write_text("\n".join(lines), encoding="utf-8")
    profile = loaded(Path("lab"))
    world, _ = ground(profile)
    assert world is not None
    said: Diagnostics = look_at_map(profile, world).diagnostics
    return render_full(said, folder_sources(Path("lab")))


def test_every_mistake_is_told_with_its_place(markdown, tmp_path, monkeypatch) -> None:
    count = itertools.count()

    def produce(text: str) -> str:
        if text.startswith("{"):
            source = Source("drive.jsonl", text)
            _, said = read_scans(source, bench())
            return render_full(said, {source.file: source})
        if not text.startswith("map:"):
            return of_yaml(text)
        place = tmp_path / str(next(count))
        place.mkdir()
        monkeypatch.chdir(place)
        return of_profile(place, text)

    markdown(Path(__file__).with_name("errors.md"), produce)

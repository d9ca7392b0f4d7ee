"""However a profile is broken, the answer is a profile or an error with a place; never an exception."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st

from tests.profiles.changed import SMALL
from xei_lang.diagnostics import has_errors
from xei_lang.diagnostics.render.full import render_full
from xei_lang.profiles.load import load_profile
from xei_lang.profiles.sources import folder_sources
from xei_lang.world.ground import ground

FILES = sorted(str(path.relative_to(SMALL)) for path in SMALL.rglob("*.*") if path.is_file())
PIECES = [
    "",
    "\n",
    "  ",
    ": ",
    "- ",
    "{",
    "}",
    "[",
    "]",
    "null",
    "-1 mm",
    "0",
    "1e9",
    "'",
    '"',
    "on",
    "ä",
    "\x00",
    "world",
    "rack",
    "tube_a",
    "A1",
    "<",
    ">",
    "\t",
    "10 kg",
    "slide",
]


@st.composite
def mutations(draw: st.DrawFn) -> tuple[str, str]:
    file = draw(st.sampled_from(FILES))
    text = (SMALL / file).read_text(encoding="utf-8")
    for _ in range(draw(st.integers(1, 2))):
        start = draw(st.integers(0, len(text)))
        end = start + draw(st.integers(0, 12))
        text = text[:start] + draw(st.sampled_from(PIECES)) + text[end:]
    return file, text


@settings(max_examples=60, deadline=None)
@given(mutations())
def test_no_damage_is_an_exception(mutation: tuple[str, str]):
    file, text = mutation
    with tempfile.TemporaryDirectory() as folder:
        lab = Path(folder) / "lab"
        shutil.copytree(SMALL, lab)
        (lab / file).write_text(text, encoding="utf-8")
        profile, found = load_profile(lab, None)
        assert (profile is None) == has_errors(found)
        if profile is not None:
            world, _ = ground(profile)
            assert world is not None
            assert all(world.T_world_frame(frame.name) for frame in world.frames)
        assert not found or render_full(found, folder_sources(lab))

"""The robot's description follows from its figures, and the figures make physical sense."""

from __future__ import annotations

import importlib.util
import math
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
import yaml

FOLDER = Path(__file__).parents[2] / "profiles" / "openarm_bench" / "robot"


@pytest.fixture(scope="module")
def generate() -> ModuleType:
    spec = importlib.util.spec_from_file_location("generate", FOLDER / "generate.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def figures() -> dict[str, Any]:
    return yaml.safe_load((FOLDER / "figures.yaml").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def urdf() -> ElementTree.Element:
    return ElementTree.parse(FOLDER / "openarm_mobile.urdf").getroot()


@pytest.mark.parametrize("kind", ["urdf", "srdf"])
def test_the_stored_description_is_what_the_figures_give(
    kind: str, generate: ModuleType, figures: dict[str, Any]
) -> None:
    stored = (FOLDER / f"openarm_mobile.{kind}").read_bytes()
    assert getattr(generate, kind)(figures).encode() == stored


def test_every_group_of_figures_names_known_sources(figures: dict[str, Any]) -> None:
    known = set(figures["sources"])
    for name in ("base", "slide", "body", "mounts", "joints", "links", "hand", "fingers", "states"):
        words = set(figures[name]["source"].replace(",", " ").split())
        assert words & known, name
    assert all(source["license"] for source in figures["sources"].values())


def test_every_inertia_obeys_the_triangle_inequality(urdf: ElementTree.Element) -> None:
    inertias = urdf.findall("link/inertial/inertia")
    assert len(inertias) > 20
    for inertia in inertias:
        xx, xy, xz, yy, yz, zz = (
            float(inertia.attrib[k]) for k in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
        )
        smallest, middle, largest = np.linalg.eigvalsh(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))
        assert smallest > 0
        assert smallest + middle >= largest


def test_capsules_are_declared_and_as_long_as_their_axes(
    urdf: ElementTree.Element, figures: dict[str, Any]
) -> None:
    declared = {str(capsule.get("name")) for capsule in urdf.findall("link/collision_checking/capsule")}
    cylinders = {
        str(collision.get("name")): float(collision.find("geometry/cylinder").attrib["length"])  # type: ignore[union-attr]
        for collision in urdf.findall("link/collision")
        if collision.find("geometry/cylinder") is not None
    }
    assert declared == set(cylinders)
    assert len(declared) == 14
    capsule = figures["links"]["link3"]["shapes"][0]["capsule"]
    assert math.isclose(
        cylinders["openarm_left_link3_0"], math.dist(capsule["p0"], capsule["p1"]), rel_tol=1e-9
    )


def test_every_disabled_pair_has_a_reason_and_existing_links(urdf: ElementTree.Element) -> None:
    links = {link.get("name") for link in urdf.findall("link")}
    srdf = ElementTree.parse(FOLDER / "openarm_mobile.srdf").getroot()
    pairs = srdf.findall("disable_collisions")
    assert pairs
    for pair in pairs:
        assert {pair.get("link1"), pair.get("link2")} <= links
        assert pair.get("reason")


def test_no_pair_across_the_arms_is_disabled_but_the_mounts() -> None:
    srdf = ElementTree.parse(FOLDER / "openarm_mobile.srdf").getroot()
    across = [
        {pair.get("link1"), pair.get("link2")}
        for pair in srdf.findall("disable_collisions")
        if "_left_link" in str(pair.get("link1")) and "_right_link" in str(pair.get("link2"))
    ]
    assert across == [{"openarm_left_link0", "openarm_right_link0"}]

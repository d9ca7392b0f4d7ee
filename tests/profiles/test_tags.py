"""Tags that no family has, and tags as large as a wall."""

from __future__ import annotations

import cv2
import pytest

from tests.profiles.changed import changed_profile
from xei_lang.profiles.checks.names import TAGS
from xei_lang.profiles.load import load_profile

TAG = """calibration_profile.yaml
- tags: []
+ tags: [{id: ID, size: SIZE, frame: table, position: [0 m, 0 m, 0 m], rpy: [0 deg, 0 deg, 0 deg]}]"""


@pytest.mark.parametrize(
    ("number", "size", "codes", "said"),
    [
        ("586", "50 mm", [], ""),
        ("587", "50 mm", ["XEI0620"], "`tag36h11` has no tag 587"),
        ("3", "50 m", ["XEI0610"], "a tag of more than a metre is a slip of the unit"),
        ("3", "1 m", [], ""),
    ],
)
def test_a_tag_is_one_of_its_family_and_no_wall(tmp_path, number, size, codes, said):
    change = TAG.replace("ID", number).replace("SIZE", size)
    _, found = load_profile(changed_profile(tmp_path, change), None)
    errors = [one for one in found if one.severity == "error"]
    assert [one.code for one in errors] == codes
    assert said in "".join(one.message for one in errors)


@pytest.mark.parametrize("family", sorted(TAGS))
def test_the_families_are_as_large_as_the_detector_has_them(family):
    dictionary = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, f"DICT_APRILTAG_{family[3:]}"))
    assert len(dictionary.bytesList) == TAGS[family]

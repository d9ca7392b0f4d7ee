"""A recorded request is about this lab, or is refused before anybody is asked."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.world.perception.pictures import lab, small_request
from xei_lang.world.perception.pose_request import PoseRequest
from xei_lang.world.perception.unfit import unfit


def asked(**changes: object) -> PoseRequest:
    """The request for a bottle, with changes to its picture or its query."""
    request = small_request("bottle_1")
    picture = {name: value for name, value in changes.items() if hasattr(request.picture, name)}
    query = {name: value for name, value in changes.items() if name not in picture}
    return replace(
        request,
        picture=replace(request.picture, **picture),
        queries=(replace(request.queries[0], **query),),
    )


def test_a_request_about_this_lab_passes() -> None:
    assert unfit(lab(), asked()) is None
    assert unfit(lab(), asked(output_frame="world")) is None


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"output_frame": "tabel"},
         "it wants poses in `tabel`, which is no frame of `openarm_bench`; did you mean `table`?"),
        ({"rgb_png": b"\0"}, "its `rgb_png` is of no use: it is no PNG"),
        ({"object_id": "dragon"}, "it asks for `dragon`, which is no object of `openarm_bench`"),
        ({"mesh_sha256": "0" * 64}, "it asks for `bottle_1` of the shape 000000000000, and"),
        ({"mask_png": b"\0"}, "the mask of `bottle_1` is of no use: it is no PNG"),
    ],
)  # fmt: skip
def test_what_is_of_another_lab_is_told(changes: dict[str, object], said: str) -> None:
    found = unfit(lab(), asked(**changes))
    assert found is not None and found.startswith(said), found

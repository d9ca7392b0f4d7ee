"""A pose service that is asked during a run, with a recorded picture for each goal that perceives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.world import World
from xei_lang.profiles.model import Profile
from xei_lang.world.perception.client import PoseClient
from xei_lang.world.perception.observe import ask_for, observe
from xei_lang.world.perception.pose_request import PoseRequest
from xei_lang.world.perception.registry import registry_of
from xei_lang.world.perception.seen import Seen
from xei_lang.world.perception.service_fault import ServiceFault


@dataclass(frozen=True, slots=True)
class RecordedPictures:
    """A service and the pictures that it is shown, which are taken to be of the moment of their goals.

    Of a picture's own queries the masks are kept; who is asked for is what the run needs to know, and what
    the recording asks for besides.
    """

    client: PoseClient
    by_goal: Mapping[str, PoseRequest]

    def look(
        self, goal_id: str, asked: tuple[str, ...], profile: Profile, world: World
    ) -> Seen | ServiceFault | Diagnostic:
        """What the service finds in the picture of this goal, and the picture bears out."""
        recorded = self.by_goal.get(goal_id)
        if recorded is None:
            return ServiceFault(
                "no_picture", f"there is no picture for goal `{goal_id}`", "give one `--perceived` for it"
            )
        picture = recorded.picture
        if picture.output_frame != "world" and world.frame(picture.output_frame) is None:
            message = f"the picture for goal `{goal_id}` is placed in `{picture.output_frame[:60]}`"
            return ServiceFault("no_picture", f"{message}, which is no frame of this lab", "record it again")
        registry = registry_of(profile)
        own = {query.object_id: query for query in recorded.queries}
        names = [name for name in dict.fromkeys((*asked, *own)) if registry.find(name) is not None]
        request = ask_for(picture, registry, names, request_id=goal_id, session_id=recorded.session_id)
        queries = tuple(
            replace(query, mask_png=own[query.object_id].mask_png, mode=own[query.object_id].mode)
            if query.object_id in own
            else query
            for query in request.queries
        )
        request = replace(request, queries=queries)
        return observe(self.client, profile, request, now_ns=picture.stamp_ns, world=world)

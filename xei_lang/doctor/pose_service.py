"""Whether a pose service is there, is ready, and speaks for the registry of a profile."""

from __future__ import annotations

from typing import TYPE_CHECKING

from xei_lang.doctor.blocker import Blocker
from xei_lang.profiles.model import Profile

if TYPE_CHECKING:
    from xei_lang.world.perception.client import PoseClient

REPRESENTATION = "world"


def pose_service_blockers(profile: Profile, client: PoseClient) -> tuple[Blocker, ...]:
    """What keeps a run from being grounded by this service: one blocker, or none. The service is asked."""
    from xei_lang.world.perception.registry import registry_of
    from xei_lang.world.perception.service_fault import ServiceFault

    found = client.health(registry_of(profile))
    if not isinstance(found, ServiceFault):
        return ()
    status = found.reason.replace("_", " ")
    code = found.diagnostic().code
    measure = f"{found.help}: {found.message}"
    return (Blocker(code, REPRESENTATION, "pose_service", status, "hardware", measure, "--pose-service"),)

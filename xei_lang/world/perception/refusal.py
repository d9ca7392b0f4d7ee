"""Why an image fixes no frame, as data: nothing is guessed where the pixels do not say it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from xei_lang.diagnostics import Diagnostic

Reason = Literal[
    "no_image", "wrong_size", "no_contrast", "no_tags", "mirrored", "unknown_tags", "duplicate_tags",
    "too_few_tags", "ambiguous", "wrong_tag_size", "residual",
]  # fmt: skip

_CODES = {
    "no_image": "XEI0680",
    "wrong_size": "XEI0680",
    "no_contrast": "XEI0680",
    "no_tags": "XEI0681",
    "mirrored": "XEI0680",
    "unknown_tags": "XEI0681",
    "duplicate_tags": "XEI0682",
    "too_few_tags": "XEI0681",
    "ambiguous": "XEI0681",
    "wrong_tag_size": "XEI0682",
    "residual": "XEI0682",
}


@dataclass(frozen=True, slots=True)
class Refused:
    """A detection that is not to be used: `reason` for programs, `message` and `help` for people."""

    reason: Reason
    message: str
    help: str
    tag_ids: tuple[int, ...] = ()

    def diagnostic(self) -> Diagnostic:
        """The refusal as it is shown."""
        return Diagnostic(_CODES[self.reason], self.message, help=(self.help,))

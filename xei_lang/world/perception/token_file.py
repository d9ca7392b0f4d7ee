"""What a token file must hold."""

from __future__ import annotations

from xei_lang.diagnostics import Diagnostic

MIN_TOKEN = 16


def token_of(text: str) -> str | Diagnostic:
    """The token in the text of a token file: its only line, of printable ASCII without spaces."""
    token = text.strip()
    if len(token) < MIN_TOKEN or not all("!" <= letter <= "~" for letter in token):
        return Diagnostic(
            "XEI0698",
            f"a token has {MIN_TOKEN} letters or more, on one line, without spaces",
            help=("write a long random text: `openssl rand -hex 32 > pose.token`",),
        )
    return token

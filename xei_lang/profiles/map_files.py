"""The files of the map that a calibration profile names, and whether they are the ones that it means."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

from xei_lang.diagnostics import Diagnostic, Source
from xei_lang.profiles.model import MapFiles, Profile

MAX_IMAGE_BYTES = 100_000_000
MAX_YAML_BYTES = 1_000_000


@dataclass(frozen=True, slots=True, eq=False)
class MapBytes:
    """What the two files hold; `image_name` is the image's path for messages."""

    yaml: Source
    image: bytes
    image_name: str
    sha256: str


def read_map_files(profile: Profile, named: MapFiles) -> MapBytes | Diagnostic:
    """Both files of a profile's map, or why one of them cannot be had (XEI0665)."""
    found: list[bytes] = []
    for key, path, limit in (
        ("yaml", named.yaml, MAX_YAML_BYTES),
        ("image", named.image, MAX_IMAGE_BYTES),
    ):
        if Path(path).is_absolute() or ".." in path.split("/"):
            message = f"the map's `{key}` is `{path}`, which leaves the profile's folder"
            return Diagnostic(
                "XEI0665", message, named.span, help=("copy the map into the profile's folder",)
            )
        data = read_limited(Path(profile.folder) / path, limit)
        if isinstance(data, str):
            message = f"the map's `{key}`, `{path}`, {data}"
            help_ = (f"put it at `{profile.folder}/{path}`, or name another one under `map`",)
            return Diagnostic("XEI0665", message, named.span, help=help_)
        found.append(data)
    shown = f"{profile.folder}/{named.yaml}"
    return map_bytes(shown, found[0], f"{profile.folder}/{named.image}", found[1], named)


def map_bytes(
    yaml_name: str, yaml: bytes, image_name: str, image: bytes, named: MapFiles | None = None
) -> MapBytes | Diagnostic:
    """The two files as text and bytes; XEI0665 where the first is no UTF-8."""
    try:
        source = Source(yaml_name, yaml.decode("utf-8"))
    except UnicodeDecodeError:
        message = f"`{yaml_name}` is not UTF-8 text"
        return Diagnostic("XEI0665", message, named.span if named else None)
    return MapBytes(source, image, image_name, map_sha256(yaml, image))


def map_sha256(yaml: bytes, image: bytes) -> str:
    """The SHA-256 of a map, as `cat lab.yaml lab.pgm | sha256sum` has it: the YAML file, then the image."""
    return hashlib.sha256(yaml + image).hexdigest()


def read_limited(path: Path, limit: int) -> bytes | str:
    """The bytes of a file, or in words why they cannot be had."""
    try:
        if path.exists() and not path.is_file():
            return "is no file"
        with path.open("rb") as file:
            data = file.read(limit + 1)
    except (OSError, ValueError) as error:
        return "does not exist" if isinstance(error, FileNotFoundError) else "cannot be read"
    return data if len(data) <= limit else f"is larger than {limit // 1_000_000} MB"

"""YAML text to a tree with places.

Built from parser events without recursion, so that no input can exhaust the stack; duplicate keys, aliases,
anchors, tags, merge keys and ambiguous words are diagnostics, because a profile moves a robot and must hold
just what its reader sees.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import yaml

from xei_lang.diagnostics import Diagnostic, Diagnostics, Label, Span
from xei_lang.profiles.yaml_scalars import Surprise, read_plain
from xei_lang.profiles.yaml_tree import Node

MAX_DEPTH = 40
_UNSEEN = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069]")


def read_yaml(file: str, text: str) -> tuple[Node | None, Diagnostics]:
    """The tree of one YAML document whose root is a mapping; None where there is none.

    `file` is the name that spans carry.
    """
    builder = _Builder(file, text)
    try:
        builder.run()
    except yaml.MarkedYAMLError as error:
        builder.say_broken(error)
        return None, tuple(builder.found)
    except yaml.YAMLError as error:
        builder.say(
            "XEI0603",
            f"`{_base(file)}` cannot be read as YAML",
            Span(file, 0, 0),
            label=str(error).splitlines()[0],
        )
        return None, tuple(builder.found)
    root = builder.root
    if not builder.stopped and (root is None or root.kind != "map"):
        span = root.span if root else Span(file, 0, min(1, len(text)))
        what = (
            "is empty"
            if root is None or (root.scalar is None and root.kind == "scalar")
            else "is not a mapping of keys to values"
        )
        builder.say("XEI0603", f"`{_base(file)}` {what}", span, label="expected keys such as `version: 1`")
    return (root if root and root.kind == "map" and not builder.stopped else None), tuple(builder.found)


@dataclass(slots=True)
class _Open:
    """A mapping or list that is not closed yet; `key` waits for its value."""

    node: Node
    key: str | None = None


class _Builder:
    """Turns events into nodes; faults are collected, and what they stand at is left out of the tree."""

    def __init__(self, file: str, text: str) -> None:
        self.file = file
        self.text = text
        self.root: Node | None = None
        self.found: list[Diagnostic] = []
        self.stopped = False
        self._stack: list[_Open] = []

    def run(self) -> None:
        for event in self._events():
            if isinstance(event, (yaml.MappingStartEvent, yaml.SequenceStartEvent)):
                self._open(event)
            elif isinstance(event, (yaml.MappingEndEvent, yaml.SequenceEndEvent)):
                self._close(event)
            elif isinstance(event, yaml.AliasEvent):
                self._refuse(event, "an alias", "`*` repeats something from elsewhere")
                self._put(Node("scalar", self._span(event)))
            elif isinstance(event, yaml.ScalarEvent):
                self._scalar(event)
            if self.stopped:
                return

    def say(self, code: str, message: str, span: Span, **rest: object) -> None:
        self.found.append(Diagnostic(code, message, span, **rest))  # type: ignore[arg-type]

    def say_broken(self, error: yaml.MarkedYAMLError) -> None:
        mark = error.problem_mark or error.context_mark
        at = min(mark.index, len(self.text)) if mark else 0
        labels = ()
        if error.context and error.context_mark and error.context_mark.index != at:
            start = min(error.context_mark.index, len(self.text))
            labels = (Label(Span(self.file, start, start + 1), error.context),)
        self.say(
            "XEI0603",
            f"`{_base(self.file)}` is not valid YAML",
            Span(self.file, at, min(at + 1, len(self.text))),
            label=error.problem or "",
            labels=labels,
            help=("check indentation, brackets and quotes just before this place",),
        )

    def _events(self) -> Iterator[yaml.Event]:
        documents = 0
        loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
        parse: Callable[..., Iterator[yaml.Event]] = yaml.parse  # pyright: ignore[reportUnknownMemberType, reportUnknownVariableType]
        for event in parse(self.text, Loader=loader):
            documents += isinstance(event, yaml.DocumentStartEvent)
            if documents > 1:
                self.say(
                    "XEI0603",
                    "a second document begins here",
                    self._span(event),
                    label="a profile is one document",
                )
                self.stopped = True
                return
            yield event

    def _span(self, event: yaml.Event) -> Span:
        return Span(self.file, event.start_mark.index, event.end_mark.index)

    def _open(self, event: yaml.NodeEvent) -> None:
        self._refuse_marks(event)
        kind = "map" if isinstance(event, yaml.MappingStartEvent) else "list"
        node = Node(kind, self._span(event))
        if self._stack and self._stack[-1].node.kind == "map" and self._stack[-1].key is None:
            self.say("XEI0603", "a key must be a plain word", node.span, label="found a mapping or a list")
            self.stopped = True
        self._put(node)
        self._stack.append(_Open(node))
        if len(self._stack) > MAX_DEPTH:
            self.say("XEI0603", f"values are nested more than {MAX_DEPTH} levels deep", node.span)
            self.stopped = True

    def _close(self, event: yaml.Event) -> None:
        node = self._stack.pop().node
        last = node.elements[-1].span.end if node.elements else node.span.start
        if node.items:
            last = max(item.span.end for item in node.items.values())
        flow_end = event.end_mark.index if event.end_mark.index > event.start_mark.index else last
        node.span = Span(self.file, node.span.start, max(flow_end, last))

    def _scalar(self, event: yaml.ScalarEvent) -> None:
        self._refuse_marks(event)
        span = self._span(event)
        self._refuse_unseen(event.value, span)
        top = self._stack[-1] if self._stack else None
        value = read_plain(event.value) if not event.style else event.value
        if isinstance(value, Surprise):
            self.say(
                "XEI0604",
                f"`{event.value}` would be read as {value.reads_as}",
                span,
                label=value.label,
                notes=(f"YAML 1.1 makes {value.reads_as} of an unquoted `{event.value}`",),
                help=(f"write {value.write}",),
            )
            value = event.value
        if top and top.node.kind == "map" and top.key is None:
            self._take_key(top, event.value, span)
        else:
            self._put(Node("scalar", span, value))

    def _refuse_unseen(self, text: str, span: Span) -> None:
        """An escape in quotes can make what no reader sees and what a terminal obeys."""
        unseen = _UNSEEN.search(text)
        if unseen:
            self.say(
                "XEI0603",
                "a text holds a control character",
                span,
                label=f"U+{ord(unseen[0]):04X} is not seen",
                help=("leave it out",),
            )

    def _take_key(self, top: _Open, key: str, span: Span) -> None:
        top.key = key
        if key == "<<":
            self.say(
                "XEI0605",
                "a merge key is used",
                span,
                label="`<<` copies keys from elsewhere",
                help=("write the keys out where they hold",),
            )
        if key in top.node.keys:
            self.say(
                "XEI0606",
                f"`{key}` stands twice",
                span,
                label="given again here",
                labels=(Label(top.node.keys[key], "first given here"),),
                notes=("YAML would silently keep only the last of them",),
                help=("keep one of the two",),
            )
        else:
            top.node.keys[key] = span

    def _put(self, node: Node) -> None:
        if not self._stack:
            self.root = node
            return
        top = self._stack[-1]
        if top.node.kind == "list":
            top.node.elements.append(node)
        elif top.key is not None:
            top.node.items.setdefault(top.key, node)
            top.key = None

    def _refuse_marks(self, event: yaml.NodeEvent) -> None:
        tag = getattr(event, "tag", None)
        if event.anchor:
            self._refuse(event, "an anchor", f"`&{event.anchor}` names this for reuse elsewhere")
        if tag and not (tag == "!" and isinstance(event, yaml.ScalarEvent)):
            self._refuse(
                event,
                "a tag",
                f"`{self.text[event.start_mark.index :].split(maxsplit=1)[0]}` changes how this is read",
            )

    def _refuse(self, event: yaml.Event, what: str, why: str) -> None:
        self.say(
            "XEI0605",
            f"{what} is used",
            self._span(event),
            label=why,
            notes=("a profile says everything where it holds, so that a reader sees what a robot will do",),
            help=("write the value out where it is needed",),
        )


def _base(file: str) -> str:
    return file.rsplit("/", 1)[-1]

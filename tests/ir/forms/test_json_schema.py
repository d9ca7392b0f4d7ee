"""Our validator of the plan's form finds fault with what the library finds fault with, at the same places."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import jsonschema
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.check.checking import plan_of
from tests.check.test_properties import RICH
from xei_lang.diagnostics import Source
from xei_lang.ir.forms import plan_json
from xei_lang.ir.forms.json_reader import read_json
from xei_lang.ir.forms.json_schema import ANNOTATIONS, KEYWORDS, pointer_text, violations

SCHEMA = json.loads(Path(plan_json.__file__).with_name("plan.schema.json").read_text(encoding="utf-8"))
PLAN = plan_json.to_json(plan_of(RICH), {})
VALUES = st.sampled_from(
    [None, True, 0, 1, -1, 1.0, 1.5, "", "a", "wait", "start", [], ["a"], ["a", "a"], [0, None], [1, 2, 3],
     {}, {"value": 1, "unit": "mL"}, {"value": "1", "unit": "mL"}, {"value": 1},
     {"at": {"x": "y"}}, {"at": "x"},
     {"measured": "od", "lower": 0, "upper": 1}, {"measured": "od"}, {"procedure": "p", "line": 3}]
)  # fmt: skip
KEYS = st.sampled_from(
    ["version", "skill_calls", "step_id", "skill", "args", "kind", "after", "stray", "exact"]
)


def places(value: Any, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [path, *(found for key, item in inner for found in places(item, (*path, key)))]


PLACES = places(PLAN)[1:]


@st.composite
def changed(draw: st.DrawFn) -> Any:
    """The plan with a few places taken out, put in or given another value."""
    plan: Any = copy.deepcopy(PLAN)
    for path in draw(st.lists(st.sampled_from(PLACES), max_size=3)):
        owner = plan
        try:
            for key in path[:-1]:
                owner = owner[key]
            match draw(st.sampled_from(["set", "drop", "add"])):
                case "set":
                    owner[path[-1]] = draw(VALUES)
                case "drop":
                    del owner[path[-1]]
                case _ if isinstance(owner, dict):
                    owner[draw(KEYS)] = draw(VALUES)
        except (KeyError, IndexError, TypeError):
            continue
    return plan


@settings(max_examples=300)
@given(plan=changed())
def test_it_refuses_what_the_library_refuses(plan: Any) -> None:
    node, said = read_json(Source("p.json", json.dumps(plan)))
    assert node is not None, said
    found = list(violations(node, SCHEMA, "XEI0111"))
    wanted = list(jsonschema.Draft202012Validator(SCHEMA).iter_errors(plan))
    assert bool(found) == bool(wanted)
    ours = {item.pointer for item in found}
    for error in wanted:
        path = tuple(error.absolute_path)
        assert any(pointer[: len(path)] == path for pointer in ours), (path, error.message)


def test_it_knows_every_word_that_the_schema_uses() -> None:
    def words(schema: Any) -> set[str]:
        named = ("properties", "$defs")
        inner = [item for key in named for item in schema.get(key, {}).values()]
        inner += [
            schema[key] for key in ("items", "additionalProperties", "if", "then", "else") if key in schema
        ]
        inner += schema.get("prefixItems", [])
        return set(schema) | {word for item in inner if isinstance(item, dict) for word in words(item)}

    assert words(SCHEMA) <= {*KEYWORDS, *ANNOTATIONS}


def test_pointers_are_escaped() -> None:
    assert pointer_text(("skill_calls", 0, "a/b~c")) == "/skill_calls/0/a~1b~0c"
    assert pointer_text(()) == ""

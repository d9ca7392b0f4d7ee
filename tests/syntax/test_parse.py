"""Every construct of the language parses, into the tree that it means."""

from __future__ import annotations

from typing import Any

import pytest

from tests.syntax import corpus
from xei_lang.diagnostics import Source
from xei_lang.quantity import parse_quantity
from xei_lang.syntax import (
    Parser,
    ast,
    parse_expression,
    parse_module,
    parse_predicate,
    parse_role_expression,
)

PARSER = Parser()


def module_of(text: str) -> ast.Module:
    module, diagnostics = PARSER.module(Source("t.xei", text))
    assert [diagnostic.message for diagnostic in diagnostics] == []
    assert module is not None
    return module


def member_of(text: str) -> Any:
    protocol = module_of(corpus.in_protocol(text)).items[-1]
    assert isinstance(protocol, ast.Protocol)
    (member,) = protocol.body
    return member


@pytest.mark.parametrize("member", corpus.MEMBERS.values(), ids=corpus.MEMBERS.keys())
def test_members_parse(member: str) -> None:
    module_of(corpus.in_protocol(member))


@pytest.mark.parametrize("text", corpus.FILES.values(), ids=corpus.FILES.keys())
def test_files_parse(text: str) -> None:
    module_of(text)


def test_whole_protocol() -> None:
    module = module_of(corpus.WHOLE)
    assert module.version is not None
    assert module.version.value == 1
    _, protocol = module.items
    assert isinstance(protocol, ast.Protocol)
    assert protocol.doc == "Pour buffer into four tubes, close the bottle, incubate."
    kinds = [
        type(member.action if isinstance(member, ast.Step) else member).__name__ for member in protocol.body
    ]
    assert kinds == [
        *("ProfileDecl", "Param", "ObjectDecl", "ObjectDecl", "GivenContains", "Given"),
        *("Call", "Call", "For", "Call", "Call", "Parallel", "Wait", "Require", "Unmapped", "Note"),
    ]
    labels = [member.label.id for member in protocol.body if isinstance(member, ast.Step) and member.label]
    assert labels == ["open", "close", "incubate"]
    assert [comment.is_doc for comment in module.comments] == [True, False, False]


def test_layout_means_nothing() -> None:
    spread = module_of(corpus.WHOLE.replace("(", "(\n").replace(" =", "\n=").replace("##", "# a\n##"))
    assert ast.equal_up_to_spans(module_of(corpus.WHOLE).items, spread.items)
    changed = module_of(corpus.WHOLE.replace("4 mL", "5 mL"))
    assert not ast.equal_up_to_spans(module_of(corpus.WHOLE).items, changed.items)


def test_call_keeps_the_places_of_names_and_values() -> None:
    text = corpus.in_protocol("open: twist(object=bottle, 2 mL)")
    source = Source("t.xei", text)
    step = member_of("open: twist(object=bottle, 2 mL)")
    call = step.action
    named, positional = call.args
    assert [source.slice(node.span) for node in (step.label, call.callee, named.name, named.value)] == [
        *("open", "twist", "object", "bottle"),
    ]
    assert (positional.name, source.slice(positional.span)) == (None, "2 mL")
    assert source.slice(step.span) == "open: twist(object=bottle, 2 mL)"


def test_operators_bind_as_in_python() -> None:
    value = member_of("let x = not a == b + c * -d and e or f").value
    assert (value.op, value.left.op) == ("or", "and")
    negation = value.left.left
    assert (negation.op, negation.operand.op) == ("not", "==")
    total = negation.operand.right
    assert (total.op, total.right.op, total.right.right.op) == ("+", "*", "-")
    left = member_of("let x = a - b - c").value
    assert (left.right.id, left.left.right.id) == ("c", "b")


def test_numbers_and_quantities_are_exact() -> None:
    value = member_of("let x = [1, 1.0, 0.1, 2.50 mL, 70 %]").value
    one, real, tenth, volume, share = (item.value for item in value.items)
    assert (type(one), type(real).__name__, str(tenth)) == (int, "Fraction", "1/10")
    assert volume == parse_quantity("2.5 mL")
    assert share == parse_quantity("70 %")


def test_a_number_takes_its_unit_only_from_its_own_line() -> None:
    call = module_of(corpus.in_protocol("let x = 3\n  h: home()")).items[0].body
    assert isinstance(call[0].value, ast.Number)
    assert call[1].label.id == "h"


def test_strings() -> None:
    assert member_of(r'note "a \"b\" \\ \n"').text.value == 'a "b" \\ \n'


def test_label_of_start_belongs_to_its_step() -> None:
    step = member_of("start warm: heat(to=37 degC) within 5 s")
    assert step.label.id == "warm"
    assert isinstance(step.action, ast.Start)
    assert isinstance(step.clauses[0], ast.Within)


def test_clauses_follow_blocks() -> None:
    step = member_of("do { home() } within 5 min after open by 0 s .. 1 s")
    within, after = step.clauses
    assert (within.of, after.step.id, type(after.by)) == (None, "open", ast.Range)


def test_else_if_chains() -> None:
    action = member_of("if a { } else if b { } else { home() }").action
    assert isinstance(action.otherwise, ast.If)
    assert isinstance(action.otherwise.otherwise, ast.Block)


def test_for_forms() -> None:
    action = member_of("for a, b in pairs(xs) unordered { }").action
    assert ([name.id for name in action.names], action.unordered) == (["a", "b"], True)
    action = member_of("for unordered in in1 { }").action
    assert (action.names[0].id, action.iterable.id, action.unordered) == ("unordered", "in1", False)


def test_docs_belong_to_declarations() -> None:
    text = (
        "## a\n\n## b\nprotocol p {\n ## how much\n param v: Volume\n"
        " # no\n object o: movable\n ## no doc\n home()\n}"
    )
    module = module_of(text)
    protocol = module.items[0]
    assert isinstance(protocol, ast.Protocol)
    param, declared, _ = protocol.body
    assert (protocol.doc, getattr(param, "doc", None), getattr(declared, "doc", None)) == (
        "a\nb",
        "how much",
        "",
    )
    assert len(module.comments) == 5


def test_brackets_belong_to_what_they_hold() -> None:
    text = corpus.in_protocol("let x = (a + b) * (c)")
    value = module_of(text).items[0].body[0].value
    source = Source("t.xei", text)
    assert source.slice(value.left.span) == "(a + b)"
    assert source.slice(value.right.span) == "c"


@pytest.mark.parametrize("text", corpus.PREDICATES)
def test_predicates(text: str) -> None:
    predicate, diagnostics = parse_predicate(Source("bank.yaml", text))
    assert diagnostics == ()
    assert isinstance(predicate, ast.Update) == any(op in text for op in (":=", "+=", "-="))


@pytest.mark.parametrize("text", corpus.ROLES)
def test_role_expressions(text: str) -> None:
    assert parse_role_expression(Source("bank.yaml", text))[1] == ()


@pytest.mark.parametrize("text", corpus.EXPRESSIONS)
def test_expressions(text: str) -> None:
    assert parse_expression(Source("bank.yaml", text))[1] == ()


def test_update_is_no_statement() -> None:
    _, (found,) = parse_module(Source("t.xei", corpus.in_protocol("cap(x) := open")))
    assert found.code == "XEI0104"

"""Whatever parses can be checked: no text makes the checker raise, and what it accepts makes a sound plan."""

from __future__ import annotations

import re
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.check.checking import BENCH, LAB, ROOT, check, parser, plan_of, protocol
from xei_lang.diagnostics import Source, has_errors
from xei_lang.ir.verify_plan import verify_plan
from xei_lang.quantity import Quantity, quantity

RICH = """
procedure fill(tube: liquid_container, v: Volume = 1 mL in 1 mL .. 5 mL, side: Arm = left) {
  take: pick(object=cup_1, arm=side)
  pour(source=cup_1, target=tube, volume=v, pace=quick) within 30 s
  place(object=cup_1, on=table.spot("cup"))
}
protocol rich {
  profile "lab"
  param n: Int = 2 in 1 .. 3
  param volume: Volume = 2 mL in 1 mL .. 4 mL
  object rack: tube_rack & not movable = rack_2
  given cap(tube_1) == open
  given cup_1 contains 50 mL of "PBS"
  let shares = [volume / k for k in 1 .. 4 if k != 3]
  for tube, share in zip(rack_1.row("A")[1 .. 2], [shares[1], max(shares[2], 1 mL)]) {
    each: fill(tube=tube, v=share)
  }
  wash: repeat n times { a: wait 10 s  if n > 1 { wait 1 s } else { wait 2 s } }
  do { spin(object=tube_1, force=200 xg, for=1 min, turns=n, cool=true) } within 5 min
  insert(object=tube_3, into=rack.slots[n + 1]) after wash[1].a by 0 s .. 1 h
  confirm "done?"
  nav_to(station=bench)
  note "hot"
  unmapped "centrifuge" because "none"
}
"""
DECIDED = """
procedure read_twice(tube: liquid_container, enough: Float) {
  measure a: Float = read(object=tube) in 0.05 .. 2
  if a < enough { measure b: Float = read(object=tube)  require b + a > 0.1 } else { stop "dense" }
}
protocol decided {
  profile "lab"
  param most: Int = 3
  measure m: Mass = weigh(object=tube_1) in 1 g .. 5 g
  read_twice(tube=tube_1, enough=1.5)
  wash: repeat most times until od < 0.1 {
    wait 1 s
    measure od: Float = read(object=tube_2)
    pour(source=cup_1, target=tube_2, volume=max(od, 1) * 1 mL)
  } else { stop "did not clear" }
  keep temperature(tube_1) <= 8 degC and cap(tube_1) == closed {
    parallel { { wait m / (1 g) * 1 s } { wait 2 s } }
    if m > 2 g { wait 3 s } else if m > 1.5 g { confirm "light" }
  }
}
"""
PROTOCOLS = {
    path.name: path.read_text(encoding="utf-8") for path in sorted((ROOT / "protocols").glob("*.xei"))
}
WORDS = sorted(set(re.findall(r'\w+|"[^"]*"|[^\s\w]', RICH + DECIDED + "".join(PROTOCOLS.values()))))


def test_the_rich_protocol_is_sound() -> None:
    plan = plan_of(RICH)
    assert verify_plan(plan) == ()
    assert len(plan.steps) == 14


@pytest.mark.parametrize("name", PROTOCOLS)
def test_the_protocols_check_clean(name: str) -> None:
    plan, diagnostics = check(PROTOCOLS[name], BENCH)
    assert diagnostics == ()
    assert plan is not None
    assert verify_plan(plan) == ()


@given(st.data())
@settings(max_examples=300, deadline=None)
def test_no_mutation_makes_the_checker_raise(data: st.DataObject) -> None:
    text = data.draw(st.sampled_from([RICH, DECIDED, *PROTOCOLS.values()]))
    for _ in range(data.draw(st.integers(1, 3))):
        tokens = list(re.finditer(r'\w+|"[^"]*"|[^\s\w]', text))
        token = tokens[data.draw(st.integers(0, len(tokens) - 1))]
        text = text[: token.start()] + data.draw(st.sampled_from(["", *WORDS])) + text[token.end() :]
    module, said = parser().module(Source("t.xei", text))
    if module is None or has_errors(said):
        return
    for open_bindings in (False, True):
        plan, diagnostics = check(text, LAB, open_bindings=open_bindings, max_steps=500)
        assert (plan is None) == has_errors(diagnostics) or "protocol" not in text
        if plan is not None:
            assert verify_plan(plan) == ()


numbers = st.integers(1, 10**6).map(lambda n: Fraction(n, 1000))


@given(numbers, numbers, numbers)
@settings(deadline=None)
def test_lets_compute_exactly(a: Fraction, b: Fraction, c: Fraction) -> None:
    text = f"let x = ({float(a)} mL + {float(b)} uL) * {float(c)} / 2 - {float(b)} uL * 2\n"
    text += "let t = x / (1 mL / 1 s)\n"
    plan, _ = check(protocol(text + "if t > 0 s { wait t } else { wait -t }"))
    assert plan is not None
    expected = (a + b / 1000) * c / 2 - b / 500
    assert plan.steps[0].arg("duration") == quantity(abs(expected), "s")


@given(numbers, numbers)
@settings(deadline=None)
def test_an_open_parameter_covers_what_it_can_be(low: Fraction, high: Fraction) -> None:
    low, high = sorted((low, high))
    bounds = f"{float(low)} s .. {float(high)} s"
    text = protocol(
        f"param t: Time in {bounds}\nlet u = 100 s - t * 2 / 3\nif u < 0 s {{ wait 1 s }} else {{ wait 2 s }}"
    )
    open_plan = plan_of(text, open_bindings=True)
    chosen = {step.arg("duration") for step in open_plan.steps}
    for value in (low, high, (low + high) / 2):
        shown = (
            str(Quantity(value, quantity(1, "s").dimension, "s"))
            if value.denominator == 1
            else f"{float(value)} s"
        )
        closed = plan_of(text, params={"t": shown})
        assert {step.arg("duration") for step in closed.steps} <= chosen

"""Valid texts, by the construct that each shows. Members stand inside a protocol, files by themselves."""

from __future__ import annotations

MEMBERS = {
    "profile": 'profile "openarm_bench"',
    "param": "param n: Int",
    "param with limits": "param volume: Volume = 2 mL in 0.5 mL .. 4 mL",
    "param limits only": "param t: Temperature in 4 degC .. 37 degC",
    "param list": "param vs: List[Volume] = [1 mL, 2 mL,]",
    "object": "object rack: tube_rack",
    "object bound": "object bottle: liquid_container & pourable = buffer_bottle",
    "object bound to a slot": 'object tube: movable = rack_1.slot("A1")',
    "role operators": "object x: (surface | place_target) & not fragile",
    "given": "given cap(bottle) == closed",
    "given contains": 'given bottle contains 50 mL of "PBS"',
    "given contains at": "given tube contains row.volume of row.name at 5 mg/mL",
    "call": "pick(object=bottle, arm=right)",
    "call without arguments": "home()",
    "call with trailing comma": "pick(bottle, arm=right,)",
    "keywords as arguments": "heat(on=a, to=37 degC, for=10 min, in=b, at=c, by=d, of=e, start=f, volume=1 mL, if=g, xei=h)",  # noqa: E501
    "label": "open: twist_open(object=bottle)",
    "keywords as labels": "start: tap(a=1) wait: tap(a=1) note: tap(a=1) if: tap(a=1) object: tap(a=1) let: wait 1 s",  # noqa: E501
    "clause words as labels": "step: home() times: home() at: home() table: home() until: home() unordered: home()",  # noqa: E501
    "words that begin like keywords": "parallelise() do_it() notes: wait_for() format(not_x=1) ifx: inner(xeix=order)",  # noqa: E501
    "within": "pick(object=a) within 30 s",
    "within of": "close: pick(object=a) within 30 s of open",
    "after": "place(object=a) after pick_a by 0 s .. 5 min within 1 h",
    "after a path": "place(object=a) after turns[2][1] within 1 h of call.inner[3].step",
    "wait": "wait 10 min",
    "wait sum": "wait 2 * base + 30 s",
    "start": "start warm: heat(block=heater, to=37 degC)",
    "start plain": "start heat(block=heater) within 5 s",
    "start with keyword label": "start stop: heat(block=heater)",
    "await": "await warm within 30 s",
    "stop": "stop warm",
    "stop the run": 'stop "did not clear"',
    "leave": "leave warm",
    "pause": "pause warm { pick(object=a) }",
    "keep": "keep temperature(t) <= 8 degC { pick(object=t) }",
    "measure": "measure od: Float = read(device=reader, object=cuvette) in 0.05 .. 2.0",
    "measure without limits": "measure od: Float = read(device=reader) within 10 s",
    "confirm": 'confirm "Ice is in the bucket"',
    "do": "do { home() } within 5 min after open",
    "labelled do": "prep: do { home() }",
    "parallel": "parallel { { home() } { wait 1 s } }",
    "for": 'for tube in rack.row("A")[1 .. 4] { pour(target=tube) within 30 s }',
    "for range": "for i in 1 .. 8 { home() }",
    "for range with step": "for i in 1 .. n + 1 step 2 { home() }",
    "for over two": "for a, b in zip(as, bs) { move(a, to=b) }",
    "for unordered": "for x in xs unordered { home() }",
    "for over a name that begins like a keyword": "for x in in1 { home() }",
    "repeat": "repeat 3 times { home() }",
    "repeat until": 'repeat 5 times until od < 0.1 { home() } else { stop "did not clear" }',
    "if": "if od > 0.6 { home() }",
    "else if": "if a { } else if b { home() } else { }",
    "let": "let dose = 50 uL - volume(tube)",
    "let then step": "let a = b\n c: home()",
    "let then keyword step": "let a = b\n for x in a { }\n let d = a\n wait 1 s",
    "require": "require volume(bottle) >= 10 mL and not (a or b)",
    "unmapped": 'unmapped "spin" because "no centrifuge"',
    "unmapped alone": 'unmapped "spin"',
    "note": 'note "say \\"hi\\" \\\\ there"',
    "list": "let xs = []",
    "tuple": 'let xs = [(1, "A1"), (2, "A2",)]',
    "comprehension": "let xs = [2 * v for v in vs]",
    "comprehension with condition": "let xs = [f(a, b)[1] for a, b in pairs(vs) if a != b]",
    "range in comprehension": "let xs = [n for n in 1 .. 8]",
    "arithmetic": "let x = -a * (b + 2) / 3 - 1.5",
    "tight division": "let x = 10 mL/n + 2 mL/2",
    "booleans": "let x = true or false and not a == b",
    "percent": "let x = 70 % * v",
    "shuffle": "let x = shuffle(xs, seed=7)",
    "clause words behind a value": "let a = b times: home() let c = d of: wait 1 s",
    "comments": "# plain\n ## doc\n home() # after",
}

FILES = {
    "empty protocol": "protocol p { }",
    "pragma": "xei 1\nprotocol p { }",
    "imports": 'import "common/caps.xei"\nimport table "reagents.csv" as reagents\nprotocol p { }',
    "procedure": "procedure wash(tube: liquid_container, v: Volume = 1 mL in 0 mL .. 2 mL,) { pour(target=tube) }",  # noqa: E501
    "procedure without parameters": "procedure rest() { wait 1 s }",
    "procedure with declarations": "procedure rest() { given cap(x) == open }",
    "several": "procedure a() { } protocol b { a() } protocol c { }",
    "crlf and tabs": "protocol p {\r\n\twait 1 s\r\n}\r\n",
}

PREDICATES = [
    "cap(source) == open",
    "holding(arm) == source",
    "volume(source) >= volume",
    "volume(source) -= volume",
    "contents(target) += contents(source)",
    "cap(object) := open",
    "not occupied(target.slot) and upright(object)",
]

ROLES = [
    "movable",
    "movable & liquid_container",
    "surface | place_target",
    "not fragile",
    "List[Volume]",
    "(a | b) & not c",
]

EXPRESSIONS = ["4 s .. 30 s", "0.5 mL", "-20 degC", "target.height + 5 mm", "[1, 2]"]


def in_protocol(member: str) -> str:
    """A file whose one protocol has this member."""
    return f"protocol p {{\n  {member}\n}}\n"


WHOLE = """xei 1
import "common/caps.xei"

## Pour buffer into four tubes, close the bottle, incubate.
protocol aliquot_buffer {
  profile "openarm_bench"

  param volume: Volume = 2 mL in 0.5 mL .. 4 mL

  object bottle: liquid_container & pourable = buffer_bottle   # role expression, bound to a name
  object rack:   tube_rack                                     # unbound: --bind rack=rack_1

  given bottle contains 50 mL of "PBS"
  given cap(bottle) == closed

  open: twist_open(object=bottle, hold=left, twist=right)
  pick(object=bottle, arm=right)
  for tube in rack.row("A")[1 .. 4] {
    pour(source=bottle, target=tube, volume=volume) within 30 s
  }
  place(object=bottle, on=table.spot("bottle"))
  close: twist_close(object=bottle, hold=left, twist=right)

  parallel {
    { wipe(tool=wipe_1, surface=table, arm=left) }
    { tap(target=incubator_screen, element="start", arm=right) }
  }

  incubate: wait 10 min after close by 0 s .. 5 min
  require volume(bottle) >= 10 mL

  unmapped "centrifuge at 3000 g for 5 min" because "no centrifuge skill in this profile"
  note "The bottle is open between steps open and close."
}
"""

"""MotionGoalGraph as Graphviz DOT: a cluster a step, a node a goal, the edges that motion must respect."""

from __future__ import annotations

from xei_lang.ir.goals import (
    Attach,
    Detach,
    Grip,
    JointTarget,
    MotionGoal,
    MotionGoalGraph,
    MoveTo,
    NavToPose,
)

_COLOURS = {"left_arm": "#cfe3f6", "right_arm": "#f8ddc8", "base": "#d9ead3", "slide": "#ece3f4"}


def to_dot(graph: MotionGoalGraph) -> str:
    """The graph as a DOT document, goals and edges in their order; `dot -Tsvg` draws it."""
    lines = ["digraph goals {", "  rankdir=TB;", '  node [shape=box, style=filled, fontname="sans-serif"];']
    for index, step_id in enumerate(dict.fromkeys(goal.step_id for goal in graph.goals)):
        lines.append(f"  subgraph cluster_{index} {{")
        lines.append(f"    label={_quoted(step_id)};")
        lines.extend(f"    {_node(goal)}" for goal in graph.goals if goal.step_id == step_id)
        lines.append("  }")
    lines.extend(f"  {_quoted(before)} -> {_quoted(after)};" for before, after in graph.edges)
    return "\n".join([*lines, "}", ""])


def _node(goal: MotionGoal) -> str:
    colour = next((_COLOURS[name] for name in goal.resources if name in _COLOURS), "#f2f2f2")
    border = ', color="#888888", style="filled,dashed"' if goal.provisional else ""
    label = f"{goal.kind}\n{_detail(goal)}\nepoch {goal.epoch}".replace("\n\n", "\n")
    return f'{_quoted(goal.id)} [label={_quoted(label)}, fillcolor="{colour}"{border}];'


def _detail(goal: MotionGoal) -> str:
    action = goal.action
    if isinstance(action, MoveTo):
        if isinstance(action.target, JointTarget):
            return action.target.name
        return f"{action.arm}, {action.path}, {action.target.family}"
    if isinstance(action, Grip):
        return f"{action.arm} {action.opening_m * 1000:g} mm"
    if isinstance(action, (Attach, Detach)):
        return f"{action.object} {action.arm}"
    return action.station if isinstance(action, NavToPose) else ""


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'

"""Every code that a diagnostic may carry: one line each, in one place.

Ranges: 01xx files and syntax, 02xx names and binding, 03xx types, units and arguments, 04xx state and time,
05xx warnings, 06xx profiles and world, 07xx lowering and operation parameters, 08xx motion, 09xx running,
bundles and traces. A code is never reused for something else.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal


@dataclass(frozen=True, slots=True, eq=False)
class Entry:
    """What a code stands for: a title that needs no context, and how grave it is."""

    title: str
    severity: Literal["error", "warning", "info"] = "error"


_ENTRIES = {
    # 01xx files and syntax
    "XEI0101": Entry("a file cannot be read"),
    "XEI0102": Entry("a file is not UTF-8 text"),
    "XEI0103": Entry("a file has no protocol in it"),
    "XEI0104": Entry("the text does not follow the grammar"),
    "XEI0105": Entry("a construct of the language that this version does not compile yet"),
    "XEI0106": Entry("a name that is not lower case"),
    "XEI0107": Entry("a text that is too large or nested too deeply"),
    "XEI0108": Entry("a version of the language that this compiler does not know"),
    "XEI0109": Entry("more syntax errors than are shown"),
    "XEI0120": Entry("an import that leads out of the project folder"),
    "XEI0121": Entry("files that import each other in a circle"),
    "XEI0122": Entry("a file that cannot be imported"),
    # 02xx names and binding
    "XEI0201": Entry("a skill that the robot does not have"),
    "XEI0202": Entry("a name that nothing has"),
    "XEI0203": Entry("a skill that a protocol may not call"),
    "XEI0204": Entry("a skill of a part that the robot does not have"),
    "XEI0205": Entry("a place that an object does not have"),
    "XEI0206": Entry("an object that is not bound"),
    "XEI0207": Entry("a binding or parameter of the command line that the protocol does not declare"),
    "XEI0208": Entry("a parameter without a value"),
    "XEI0209": Entry("a name that is declared twice"),
    "XEI0210": Entry("a label that is used twice in one block"),
    "XEI0211": Entry("a reference to a step that does not come before"),
    "XEI0212": Entry("a declaration in a place where it cannot stand"),
    "XEI0213": Entry("two protocols in one file"),
    "XEI0214": Entry("a procedure that calls itself"),
    "XEI0215": Entry("a role or type that nothing has"),
    "XEI0240": Entry("a request that no skill does stands in a protocol that is compiled"),
    "XEI0241": Entry("a placeholder stands in a profile that is used strictly"),
    # 03xx types, units and arguments
    "XEI0301": Entry("an argument that a skill or procedure does not have"),
    "XEI0302": Entry("an argument that is missing"),
    "XEI0303": Entry("an argument that is given twice"),
    "XEI0304": Entry("an argument without its name"),
    "XEI0305": Entry("a value of the wrong type"),
    "XEI0306": Entry("a quantity of the wrong dimension"),
    "XEI0307": Entry("a number without its unit"),
    "XEI0308": Entry("a value outside of its range"),
    "XEI0309": Entry("an object without the role that is needed"),
    "XEI0310": Entry("a slot that does not accept an object"),
    "XEI0311": Entry("a place that nothing stands in, used as an object"),
    "XEI0312": Entry("an operation on values that do not go together"),
    "XEI0313": Entry("a division by zero"),
    "XEI0314": Entry("a list, range or index that does not fit"),
    "XEI0316": Entry("a plan of more steps than the bound"),
    "XEI0317": Entry("a number of turns that is no whole number"),
    "XEI0318": Entry("a state that an object does not have"),
    "XEI0319": Entry("a function or attribute that does not exist, or is used wrongly"),
    "XEI0320": Entry("lists of different lengths taken together"),
    "XEI0321": Entry("calls that lie too deep in each other"),
    "XEI0322": Entry("a bound on time that nothing can meet"),
    "XEI0330": Entry("something that two branches use, which may overlap"),
    # 05xx warnings
    "XEI0501": Entry("a declaration that nothing uses", "warning"),
    # 06xx profiles and world
    "XEI0601": Entry("a profile cannot be found"),
    "XEI0602": Entry("a file of a profile cannot be read"),
    "XEI0603": Entry("a file of a profile is not the YAML that it should be"),
    "XEI0604": Entry("a value that YAML reads otherwise than people do"),
    "XEI0605": Entry("an anchor, alias or tag in a profile"),
    "XEI0606": Entry("a key that stands twice"),
    "XEI0607": Entry("a key that a profile does not have"),
    "XEI0608": Entry("a key that a profile must have"),
    "XEI0609": Entry("a value of the wrong kind in a profile"),
    "XEI0610": Entry("a quantity in a profile that is none, or measures something else"),
    "XEI0611": Entry("a version of a profile that this xei does not read"),
    "XEI0620": Entry("a name in a profile that nothing has"),
    "XEI0621": Entry("a name in a profile that two things have"),
    "XEI0622": Entry("an expression in the skill bank that cannot be read"),
    "XEI0623": Entry("a template that names what its skill does not have"),
    "XEI0624": Entry("a prior place that does not exist or does not take the object"),
    "XEI0625": Entry("a role that a skill asks for and no object has", "warning"),
    "XEI0630": Entry("frames that do not form one tree"),
    "XEI0640": Entry("sizes in a profile that contradict each other"),
    "XEI0641": Entry("two objects in one place"),
    "XEI0642": Entry("two objects that stand in each other"),
    "XEI0643": Entry("an object below the surface that it should stand on"),
    "XEI0650": Entry("the robot's description cannot be read"),
    "XEI0651": Entry("a planning limit that does not fit the robot"),
    "XEI0660": Entry("an object that no source places in the world", "info"),
    # 07xx lowering and operation parameters
    "XEI0701": Entry("a template that names something missing"),
    "XEI0702": Entry("an operation parameter that does not fit"),
    "XEI0703": Entry("an object that is too wide for the gripper"),
    "XEI0704": Entry("an object that no grasp reaches clear of what it stands in"),
    "XEI0705": Entry("a slot that does not accept an object"),
    "XEI0706": Entry("a place that is already occupied"),
    "XEI0707": Entry("an object that is set down or lifted but in no hand"),
    "XEI0708": Entry("an object that cannot be grasped because a hand is full"),
    "XEI0709": Entry("a gripper that moves while it holds an object"),
    "XEI0710": Entry("an object whose pose is not known"),
    "XEI0711": Entry("a place that does not exist"),
    "XEI0712": Entry("an object that carries others"),
    "XEI0713": Entry("a surface without free room"),
    "XEI0714": Entry("an object that is too wide for a slot"),
    "XEI0715": Entry("a robot that starts at no known station"),
    "XEI0716": Entry("a hand that holds something and has no carry pose"),
    # 08xx motion
    "XEI0801": Entry("an object or a place that is out of reach"),
    "XEI0802": Entry("a place that no grasp reaches without touching something"),
    "XEI0803": Entry("a path that is blocked"),
    "XEI0804": Entry("a path that no timing can follow"),
    "XEI0805": Entry("a slide height outside the slide's stroke"),
    "XEI0806": Entry("a move that motion planning does not know"),
    "XEI0807": Entry("a configuration outside the joints' range"),
    "XEI0808": Entry("a held object that cannot be brought to its carry pose"),
    "XEI0809": Entry("a held object that is tilted before it is carried"),
    "XEI0850": Entry("a timed plan is not well formed"),
    "XEI0851": Entry("a number in a timed plan is not finite"),
    "XEI0852": Entry("a timed plan does other goals than were asked for"),
    "XEI0853": Entry("a schedule breaks the order or the time of its goals"),
    "XEI0854": Entry("a joint leaves its range"),
    "XEI0855": Entry("a joint passes its velocity limit"),
    "XEI0856": Entry("a joint passes its acceleration limit"),
    "XEI0857": Entry("a joint needs more torque than it may give"),
    "XEI0858": Entry("a motion jumps"),
    "XEI0859": Entry("sampled motion is not the exact motion"),
    "XEI0860": Entry("a goal is not reached"),
    "XEI0861": Entry("a straight move leaves its line"),
    "XEI0862": Entry("two bodies touch that may not"),
    "XEI0863": Entry("a plan disagrees with itself about what a hand holds"),
    "XEI0864": Entry("an object is left in another place than asked for"),
    "XEI0865": Entry("a plan allows more than the profile's limits"),
    "XEI0866": Entry("a held object tilts more than it may"),
    "XEI0867": Entry("a plan does not begin where the robot stands"),
    # 09xx running, bundles and traces
    "XEI0901": Entry("a run does not start from a scene origin of the profile"),
    "XEI0902": Entry("a plan names something that the world does not hold"),
    "XEI0903": Entry("an object is not known surely enough to be handled"),
    "XEI0904": Entry("the representations of a run do not belong together"),
    "XEI0905": Entry("a step has a skill that this run cannot carry out"),
    "XEI0906": Entry("a request that has no skill stops a run outside the dry run"),
    "XEI0907": Entry("an operation parameter is outside what the robot can do"),
    "XEI0910": Entry("a goal does not start where the robot is"),
    "XEI0911": Entry("a hand does not hold what a goal takes for granted"),
    "XEI0912": Entry("a goal waits for a perception that has not run"),
    "XEI0913": Entry("a question to a person has no answer"),
    "XEI0914": Entry("a person declined to go on"),
    "XEI0915": Entry("a goal sets an output that the robot does not have"),
    "XEI0916": Entry("a file of answers cannot be used"),
    "XEI0920": Entry("a trajectory leaves the limits of a joint"),
    "XEI0921": Entry("a trajectory or a run is faster than allowed"),
    "XEI0922": Entry("a tool would leave the workspace"),
    "XEI0923": Entry("a hand would carry more than its payload"),
    "XEI0930": Entry("an executor is not in this version"),
    "XEI0931": Entry("an executor cannot carry out a kind of goal"),
    "XEI0932": Entry("no executor has this name"),
    "XEI0940": Entry("an executor could not carry out a goal"),
    "XEI0950": Entry("a bundle cannot be written"),
    "XEI0951": Entry("a folder that is not a bundle stands where the bundle should go"),
    "XEI0952": Entry("a bundle cannot be read"),
    "XEI0953": Entry("a file of a bundle is missing"),
    "XEI0954": Entry("a file of a bundle is not the one that was written"),
    "XEI0960": Entry("a trace was changed after it was written"),
    "XEI0961": Entry("a trace breaks off before its end"),
}

CATALOGUE: Mapping[str, Entry] = MappingProxyType(_ENTRIES)

RANGES: Mapping[str, str] = MappingProxyType(
    {
        "XEI01": "files and syntax",
        "XEI02": "names and binding",
        "XEI03": "types, units and arguments",
        "XEI04": "state and time",
        "XEI05": "warnings",
        "XEI06": "profiles and world",
        "XEI07": "lowering and operation parameters",
        "XEI08": "motion",
        "XEI09": "running, bundles and traces",
    }
)
"""What the codes of a range are about, by their first five characters."""

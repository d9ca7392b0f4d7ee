"""What is said of runs, bundles and traces: XEI09xx."""

from __future__ import annotations

from xei_lang.diagnostics.catalogue.entry import Entry

ENTRIES = {
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
    "XEI0917": Entry("an answer to what a plan does not ask"),
    "XEI0920": Entry("a trajectory leaves the limits of a joint"),
    "XEI0921": Entry("a trajectory or a run is faster than allowed"),
    "XEI0922": Entry("a tool would leave the workspace"),
    "XEI0923": Entry("a hand would carry more than its payload"),
    "XEI0930": Entry("an executor is not in this version"),
    "XEI0931": Entry("an executor cannot carry out a kind of goal"),
    "XEI0932": Entry("no executor has this name"),
    "XEI0940": Entry("an executor could not carry out a goal"),
    "XEI0941": Entry("what is seen stands elsewhere than the plan was made for"),
    "XEI0942": Entry("a perception that does not tell what a run goes on with"),
    "XEI0950": Entry("a bundle cannot be written"),
    "XEI0951": Entry("a folder that is not a bundle stands where the bundle should go"),
    "XEI0952": Entry("a bundle cannot be read"),
    "XEI0953": Entry("a file of a bundle is missing"),
    "XEI0954": Entry("a file of a bundle is not the one that was written"),
    "XEI0960": Entry("a trace was changed after it was written"),
    "XEI0961": Entry("a trace breaks off before its end"),
}

#!/usr/bin/env python3
"""Wrong physics that can be seen: each is told in words, by `--check`, at the start of a run, or when it shows.

usage: run_told.py [-v] [-k]       -v prints every check, -k keeps the results

- Decks that are read without a mistake and mean something else than their author: `--check` warns in one line of each, with the words
  that the table prints; the deck that they are made from, and all decks of the project, are told nothing.
- Dies that move and meet nothing, bodies that go through each other: in the summary.
- A body that fills a closed die, which goes on: in the summary, with the change of volume of the closed form.
- A body that passes the plane in which it is held: in the summary.
- A first mesh that no row of REMSH replaces and that is worn by the end: in the summary; not one that hardly flows.
- A body that its dies have let go, so that nothing holds it: in the summary; not one that still lies against a die. Bodies that hold one
  another are told together.
- A steel without kinetics of austenite that is heated above Ac1: in the summary; not one that has them, nor one that only cools.
- A body that friction alone holds and no longer can, on a table that tilts, between two plates, on another body: with code 3. Not a
  body that friction holds and a limit load ends.
- `KINEM SMALL` at large strain, with a body that flows and one that locks beyond its limit load, ends with code 3.
- Probes of measures of stress against the components of the same point; of nodes that stand at one place.
"""
import glob
import json
import os
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "patch"))
from patch_support import LAGAMINE, NO_CONVERGENCE, SOURCE, Checks, Run, np  # noqa: E402

LAGACYCLE = os.path.join(os.path.dirname(LAGAMINE), "lagacycle")
BASE = """TITLE  A billet in the plane
STATE  PLSTN
KINEM  LOG
BLOCK  billet PL8LS 4 steel
   0. 0.   10. 0.   10. 15.   0. 15.
   2 1.   3 1.
LAW    steel EPLA
   200000. 0.3
   LINEAR 700. 300.
LAW    rough COUL2D
   PENETR 1.E-3   PHI 0.3
DIE    upper
   SEGM  30. 15.   -5. 15.
CNT2D  billet 3 upper -3 rough
FIXED  billet 1 Y
FIXED  billet 4 X
LIC    press
   0. 0.   1. -2.
MOVE   upper Y press
STRAT  0.1 1.E-4 0.1   5 3
END
"""
TABLE = "DIE    lower\n   SEGM  -5. -1.   30. -1.\nCNT2D  billet 1 lower -3 rough\n"
# What is changed in the base, and what `--check` must say.
WRONG = {
    "yield in GPa": ({"   LINEAR 700. 300.\n": "   LINEAR 0.7 0.3\n"}, "it yields at 3.5e-6 of E"),
    "plastic modulus in another unit": ({"   LINEAR 700. 300.\n": "   LINEAR 700. 3.E5\n"}, "it hardens by 1.5 times E"),
    "backstress in another unit": ({"   LINEAR 700. 300.\n": "   LINEAR 700. 300.\n   HKIN 3.E5\n"}, "it hardens by 1.5 times E"),
    "ratio of all elements for that of neighbours": ({"2 1.   3 1.": "2 1.   3 1000."}, "an element is 31.6 times as long as the next one, at x = 2.5, y = 0.47388"),
    "a foil in other units": ({"2 1.   3 1.": "1 1.   20 1.", "10. 15.   0. 15.": "10. 15.E-2   0. 15.E-2", "30. 15.   -5. 15.": "30. 15.E-2   -5. 15.E-2",
                               "1. -2.": "1. -2.E-2"}, "an element is 1333 times as long as wide"),
    "steps in another unit": ({"0.1 1.E-4 0.1": "1.E-7 1.E-9 1.E-7"}, "the run has 1e7 steps or more"),
    "table in percent": ({"   LINEAR 700. 300.\n": "   TABLE 3\n   0. 700.\n   10. 750.\n   50. 900.\n"}, "goes to a plastic strain of 50"),
    "walked the other way": ({"30. 15.   -5. 15.": "-5. 15.   30. 15."}, "within the body of die upper"),
    "die in the part": ({"30. 15.   -5. 15.": "30. 14.   -5. 14."}, "begins 1 deep in die upper"),
    "corner in a fillet": ({"SEGM  30. 15.   -5. 15.": "SEGM  10.2 -5.   10.2 15.\n   FILLT 3. 1.E-2\n   SEGM  10.2 15.   -5. 15.",
                            "CNT2D  billet 3": "CNT2D  billet 2 3"}, "deep in die upper"),
    "moved away": ({"30. 15.   -5. 15.": "30. 16.   -5. 16.", "1. -2.": "1. 2."}, "does not meet the part"),
    "moved away from where it lies": ({"1. -2.": "1. 2."}, "does not meet the part"),
    "stroke too short": ({"30. 15.   -5. 15.": "30. 18.   -5. 18."}, "does not meet the part"),
    "stroke that leaves the part": ({"MOVE   upper Y press": "MOVE   upper X press 20."}, "no longer faces the part"),
    "pressed, and then off the part": ({"1. -2.": "0.5 -2.   1. -2.\nLIC    off\n   0. 0.   0.5 0.   1. 20.\nMOVE   upper X off"},
                                       "no longer faces the part"),
    "floating": ({"FIXED  billet 1 Y\n": TABLE, "30. 15.   -5. 15.": "30. 16.   -5. 16."}, "nothing holds it in Y before it meets"),
    "pressed where it is held": ({"FIXED  billet 4 X\n": "FIXED  billet 4 XY\n"}, "into a node at 0 15 that supports hold (FIXED)"),
    "pushed from one side": ({"FIXED  billet 1 Y\n": ""}, "dies press it along Y from one side"),
    "slides between dies": ({"FIXED  billet 4 X\n": "", "PHI 0.3": "PHI 0."}, "press it across that and without friction"),
    "free to slide": ({"FIXED  billet 4 X\n": "", "CNT2D  billet 3 upper -3 rough\n": "", "DIE    upper\n": "", "MOVE   upper Y press\n":
                       "MOVE   billet 3 Y press\n", "   SEGM  30. 15.   -5. 15.\n": "", "LAW    rough COUL2D\n": "",
                       "   PENETR 1.E-3   PHI 0.3\n": ""}, "nothing holds it in X, no support"),
    "free to turn": ({"FIXED  billet 4 X\n": "FIXED  POINT 0. 0. XY\n", "FIXED  billet 1 Y\n": "", "CNT2D  billet 3 upper -3 rough\n": "",
                      "DIE    upper\n": "", "MOVE   upper Y press\n": "FORCE  POINT 10. 15. Y 1. press\n",
                      "   SEGM  30. 15.   -5. 15.\n": "", "LAW    rough COUL2D\n": "", "   PENETR 1.E-3   PHI 0.3\n": ""},
                     "from turning about"),
    "E in GPa": ({"200000. 0.3": "200. 0.3"}, "in one unit?"),
    "nothing acts": ({"1. -2.": "1. 0."}, "nothing moves and no load acts"),
}
WRONG["stopped half way"] = ({"STRAT  0.1": "STOP   0.5\nSTRAT  0.1"}, "LIC press goes on after the end at 0.5, where it is -1: to -2 at 1")
WRONG["an operation stopped half way"] = ({"END\n": "OPERA  one\nLIC    more\n   0. 0.   1. 3.\nMOVE   upper X more\nSTOP   0.5\nEND\n"},
                                          "LIC more goes on after the end of the operation one at 0.5")
WRONG["pressed on the axis"] = ({"PLSTN": "AXISYM", "-5. 15.": "0. 15.", "LIC    press": "PRES2D billet 4 3 10. press\nLIC    press"},
                                "billet.4/press: its sides lie on the axis")
# A body that is heated, and does not expand.
HEATED = {"CNT2D  billet 3 upper -3 rough\n": "", "DIE    upper\n": "", "   SEGM  30. 15.   -5. 15.\n": "", "LAW    rough COUL2D\n": "",
          "   PENETR 1.E-3   PHI 0.3\n": "", "MOVE   upper Y press\n": "ADDEL  billet PL8TM hot\nLAW    hot HEAT\n   50. 3.6\nHEATS  billet Q 5.\nCONVE  billet 2 H 1. TS 0.\n",
          "LIC    press\n": "", "   0. 0.   1. -2.\n": "STOP   1.\n"}
WRONG["expansion in millionths"] = ({**HEATED, "steel EPLA": "steel ELATH", "200000. 0.3\n": "200000. 0.3 12.\n", "   LINEAR 700. 300.\n": ""}, "is ALPHA in 1e-6?")
# Another block beside the billet, held as it is; and what joins it.
BESIDE = "BLOCK  beside PL8LS 4 steel\n   10. 0.   20. 0.   20. 15.   10. 15.\n   2 1.   3 1.\nFIXED  beside 1 Y\nCNT2D  beside 3 upper -3 rough\n"
WRONG["blocks that only touch"] = ({"LAW    rough": BESIDE + "LAW    rough"}, "billet and beside have nodes at 7 places in common, from 10 0 to 10 15")
WRONG["heat capacity in SI"] = ({**HEATED, "steel EPLA": "steel ELATH", "200000. 0.3\n": "200000. 0.3 1.E-5\n", "   LINEAR 700. 300.\n": "", "LIC    press\n": "", "MOVE   upper Y press\n":
                                HEATED["MOVE   upper Y press\n"].replace("50. 3.6", "50. 3.6E6")}, "RHOC is 18 times E of LAW steel")
WRONG["welded by EPLA"] = (HEATED, "none of their laws expands")
# A hot body: temperatures make no strain, and its die moves away.
HOT = {"FIXED  billet 1 Y\n": "FIXED  billet 1 Y\nADDEL  billet PL8TM hot\nLAW    hot HEAT\n   50. 3.6\nSTART  T 900.\nCONVE  billet 2 H 1. TS 0.\n"}
WRONG["hot and moved away"] = ({**HOT, "1. -2.": "1. 2."}, "does not meet the part")
WRONG["hot and pushed from one side"] = ({"FIXED  billet 1 Y\n": HOT["FIXED  billet 1 Y\n"].split("\n", 1)[1]}, "along Y from one side")
WRONG["hot and pushed by a die that warms up"] = ({"FIXED  billet 1 Y\n": HOT["FIXED  billet 1 Y\n"].split("\n", 1)[1]
                                                   + "COU2DC billet 3 upper H 1.\nTDIE   upper T 20. C 100.\n"}, "along Y from one side")
WRONG["friction in percent"] = ({"PHI 0.3": "PHI 30."}, "its coefficient of friction is 30")
# Two dies that press the billet through each other, and the flange around the bore into which it is pushed.
PRESSED = {"FIXED  billet 1 Y\n": TABLE, "1. -2.": "1. -18."}
BORE = "DIE    bore\n   SEGM  10. -5.   10. 10.\n{}CNT2D  billet 2 bore -3 rough\nFIXED  billet 1 Y\n"
WRONG["dies through each other"] = (PRESSED, "dies upper and lower go through each other by their motions: no room is left for the part from about time 0.8")
WRONG["a punch through a flange"] = ({"FIXED  billet 1 Y\n": BORE.format("   SEGM  10. 10.   20. 10.\n"), "1. -2.": "1. -6."},
                                     "dies upper and bore go through each other")
# What is changed in the base, and means what it says: far below the face at the exit of a drawing die is not in its body.
RIGHT = {"a multiplier of two operations": {"END\n": "OPERA  one\nSTOP   0.5\nOPERA  two\nEND\n"},
         "stopped after the last change": {"1. -2.": "1. -2.   3. -2.", "STRAT  0.1": "STOP   2.\nSTRAT  0.1"},
         "blocks joined": {"LAW    rough": BESIDE + "JOIN   billet 2 beside 4\nLAW    rough"},
         "blocks in contact": {"LAW    rough": BESIDE + "DIE    wall SIDES billet 2\nCNT2D  beside 4 wall rough\nLAW    rough"},
         "blocks at a corner": {"LAW    rough": BESIDE.replace("10. 0.   20. 0.   20. 15.   10. 15.", "10. 15.   20. 15.   20. 30.   10. 30.")
                                .replace("CNT2D  beside 3 upper -3 rough\n", "") + "FIXED  beside 2 X\nLAW    rough"},
         "a plate wider than a bore": {"FIXED  billet 1 Y\n": BORE.format(""), "1. -2.": "1. -6."},
         "dies that close": {**PRESSED, "1. -2.": "1. -16."},
         "a die that a force presses": {"FIXED  billet 1 Y\n": TABLE.replace("lower\n", "lower PILOT 0. -1.\n", 1) + "FORCE  lower Y -1. press\n", "1. -2.": "1. -18."},
         "held XY below": {"FIXED  billet 1 Y\n": "FIXED  billet 1 XY\n"},
         "between two dies": {"FIXED  billet 1 Y\n": TABLE}, "pushed from both sides": {"FIXED  billet 1 Y\n": "PRES2D billet 1 3 1. press\n"},
         "heated and expanding": {**HEATED, "steel EPLA": "steel ELATH", "200000. 0.3\n": "200000. 0.3 1.E-5\n", "   LINEAR 700. 300.\n": ""},
         "heated and pressed": {**HEATED, "LIC    press\n": "PRES2D billet 3 3 1. press\nLIC    press\n", "   0. 0.   1. -2.\n": "   0. 0.   1. 5.\n"},
         "a die that slides along one side and presses on another": {
             "SEGM  30. 15.   -5. 15.": "SEGM  10. -5.   10. 15.\n   SEGM  10. 15.   -5. 15.",
             "CNT2D  billet 3 upper -3 rough\n": "CNT2D  billet 3 upper -3 rough\nCNT2D  billet 2 upper -3 rough\n"},
         "a punch that goes on behind where the part stood": {"SEGM  30. 15.   -5. 15.": "ARC   3. 18.   0. 15.   -3. 18.   1.E-2",
                                                              "1. -2.": "1. -5."},
         "friction up to a limit": {"PHI 0.3": "PHI 5.   M 0.3"}, "below a drawing die": {"0. 0.   10. 0.   10. 15.   0. 15.": "0. -100.   10. -100.   9.5 0.   0. 0.", "2 1.   3 1.": "2 1.   20 1.",
                                 "30. 15.   -5. 15.": "11. -10.   9. 5.\n   SEGM  9. 5.   9. 10.\n   SEGM  9. 10.   12. 10.",
                                 "CNT2D  billet 3 upper": "CNT2D  billet 2 upper", "FIXED  billet 1 Y\n": "", "upper Y press": "billet 3 Y press -1."}}
# The same as a contour, of which the remesher makes the first mesh.
BODY = {"BLOCK  billet PL8LS 4 steel\n   0. 0.   10. 0.   10. 15.   0. 15.\n   2 1.   3 1.\n":
        "BODY   billet PL8LS 4 steel\n   SEGM  0. 0.   10. 0.\n   SEGM  10. 0.   10. 15.\n   SEGM  10. 15.   0. 15.\n   SEGM  0. 15.   0. 0.\n",
        "END\n": "REMSH\nEND\n"}
# Half a billet, pressed through the plane of symmetry that it is held in; a die that goes past the end of that, or comes up to it.
WRONG["a die through the plane of symmetry"] = ({"1. -2.": "1. -18."}, "die upper goes through the plane in which FIXED billet.1 Y holds the part, by its motion: no room is left for the part from about time 0.8")
RIGHT["a die up to the plane of symmetry"] = {"1. -2.": "1. -15."}
RIGHT["a mandrel through a ring"] = {"0. 0.   10. 0.   10. 15.   0. 15.": "10. 0.   20. 0.   20. 15.   10. 15.", "SEGM  30. 15.   -5. 15.": "SEGM  10.5 40.   9.9 14.\n   SEGM  9.9 14.   -5. 14.",
                                     "CNT2D  billet 3": "CNT2D  billet 4", "FIXED  billet 4 X": "FIXED  billet 2 X", "1. -2.": "1. -18."}
WRONG["nothing moves"] = ({"MOVE   upper Y press\n": "", "LIC    press\n   0. 0.   1. -2.\n": "STOP   1.\n"}, "nothing moves and no load acts")
WRONG["contour in a die"] = ({**BODY, "30. 15.   -5. 15.": "30. 14.   -5. 14."}, "begins 1 deep in die upper")
WRONG["contour in a fillet"] = ({**WRONG["corner in a fillet"][0], **BODY}, "deep in die upper")
WRONG["contour out of reach"] = ({**BODY, "30. 15.   -5. 15.": "30. 18.   -5. 18."}, "does not meet the part")
# A thick tube of one element that locks, widened beyond its limit load.
SPHERE = """TITLE  A thick tube beyond its limit load
STATE  AXISYM
KINEM  SMALL
BLOCK  tube PL8LS 9 metal
   100. 0.   200. 0.   200. 100.   100. 100.
   1 1.   1 1.
LAW    metal EPLA
   210000. 0.3
   LINEAR 240. 0.
FIXED  tube 1 3 Y
MOVE   tube 4 X push 60.
LIC    push
   0. 0.   1. 1.
STRAT  0.1 1.E-3 0.1   5 3
END
"""
PROBES = """PROBE  q POINT mises 5. 5.
PROBE  m POINT mean_stress 5. 5.
PROBE  p1 POINT principal_1 5. 5.
PROBE  p2 POINT principal_2 5. 5.
PROBE  p3 POINT principal_3 5. 5.
PROBE  xx POINT stress_xx 5. 5.
PROBE  yy POINT stress_yy 5. 5.
PROBE  xy POINT stress_xy 5. 5.
PROBE  zz POINT stress_zz 5. 5.
PROBE  most MAX mises billet
PROBE  least MIN principal_3 billet
PROBE  one NODE UY 10. 15. billet
PROBE  two NODE UY 10. 15. cap
BLOCK  cap PL8LS 4 steel
   0. 15.   10. 15.   10. 16.   0. 16.
   2 1.   1 1.
FIXED  cap 1 XY
FIXED  cap 3 XY
"""


def changed(checks, changes):
    """The base with its lines changed."""
    text = BASE
    for old, new in changes.items():
        checks.that(text.count(old) == 1, f"the base has {old!r} once")
        text = text.replace(old, new)
    return text


def warnings_in(found):
    """Those of a summary that are no check of its numbers."""
    return [warning for warning in found["warnings"] if "check" not in warning]


def warnings_of(path):
    """Exit code, and the warnings of `--check`."""
    run = subprocess.run([LAGAMINE, path, "--check"], capture_output=True, text=True, check=False)
    return run.returncode, [line for line in run.stdout.splitlines() if line.startswith("WARNING")]


def decks(checks):
    """Wrong decks are told, right ones are not."""
    for name, (changes, words) in WRONG.items():
        path = os.path.join(checks.folder, name.replace(" ", "-") + ".lag")
        with open(path, "w", encoding="utf-8") as deck:
            deck.write(changed(checks, changes))
        code, told = warnings_of(path)
        print(f"{name:28s} {told[0] if told else ''}")
        checks.that(code == 0 and len(told) == 1 and words in told[0], f"{name}: one line with {words!r}", (code, told))
    right = []
    for name, changes in {"base": {}, **RIGHT}.items():
        right.append(os.path.join(checks.folder, name.replace(" ", "-") + ".lag"))
        with open(right[-1], "w", encoding="utf-8") as deck:
            deck.write(changed(checks, changes))
    shipped = sorted(glob.glob(os.path.join(SOURCE, "decks", "*", "*.lag")))
    checks.that(len(shipped) > 20, "decks of the project", len(shipped))
    for deck in [*right, *shipped]:
        code, told = warnings_of(deck)
        checks.that(code == 0 and not told, f"{os.path.basename(deck)}: nothing is told", (code, told))


def warned_run(checks):
    """A run has the warnings of its start in its listing and in summary.json."""
    run = Run(checks, "warned", changed(checks, WRONG["stroke too short"][0]))
    if run.ok:
        with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as summary:
            told = warnings_in(json.load(summary))
        checks.that(len(told) == 1 and "does not meet the part" in told[0]["text"], "summary.json has the warning", told)
        with open(os.path.join(run.out, "warned.log"), encoding="utf-8") as listing:
            checks.that("does not meet the part" in listing.read(), "so has the listing")


def stopped_run(checks):
    """A run that cannot go on says first what was seen of the deck."""
    run = Run(checks, "walked", changed(checks, WRONG["die in the part"][0]).replace("1. -2.", "1. -14.").replace("1.E-4", "0.1"),
              NO_CONVERGENCE)
    if run.ok:
        checks.that("WARNING before the run: billet.3/upper: the part begins 1 deep in die upper" in run.said, "what it says", run.said)
        checks.that("let the die come from that far off (MOVE)" in run.said, "what to try", run.said)


def free_dies(checks):
    """What is told of a free die at which a run stops: the card that holds one that touches nothing; of one that touches, how to go
    beyond its largest force."""
    pushed = {"MOVE   upper Y press": "FORCE  upper Y 1. press", "1. -2.": "1. -20000."}
    for name, more, phrase in (("apart", {"30. 15.   -5. 15.": "30. 16.   -5. 16.", "1. -2.": "1. 20000."},
                                "die upper is free along Y and touches nothing, nor does a force push it to a side that faces it: a SPRNG"),
                               ("too much", {"   LINEAR 700. 300.": "   LINEAR 700. 0.", "KINEM  LOG": "KINEM  SMALL", "1.E-4 0.1": "0.1 0.1"},
                                "a die that MOVE drives, in place of FORCE")):
        run = Run(checks, name.replace(" ", "-"), changed(checks, {**pushed, **more}), NO_CONVERGENCE)
        if run.ok:
            checks.that(phrase in run.said, f"a free die, {name}: what it needs", run.said)
            checks.that(("SPRNG" in run.said) == ("SPRNG" in phrase), f"a free die, {name}: no more than that", run.said)


RUBBED = """TITLE  A block that friction holds
STATE  PLSTN
KINEM  LOG
BLOCK  block PL8LS 4 soft
   {corners}
   6 1.   3 1.
LAW    soft {law}
LAW    dry COUL2D
   PENETR 1.E-3   PHI 0.25
{table}LIC    weight
   0. 0.   0.2 1.
LIC    pull
   0. 0.   0.2 0.   1. 1.
STRAT  0.02 1.E-5 0.05   5 3
END
"""
ALONG = f"{np.cos(0.3)!r} {np.sin(0.3)!r}".split()
RUBBER, FLAT = "ELA\n   2000. 0.3", "0. 0.   20. 0.   20. 6.   0. 6."
ON_DIE = "DIE    low\n   SEGM -20. 1.E-7   60. 1.E-7\nCNT2D  block 1 low 2 dry\n"
ON_BODY = "BLOCK  low PL8LS 4 soft\n   -5. -5.   30. -5.   30. 0.   -5. 0.\n   9 1.   3 1.\nDIE    top SIDES low 3\nCNT2D  block 1 top dry\nFIXED  low 1 XY\n"
# What holds the block; the time when friction gives way, a quarter of the weight.
SLIDES = {
    "on a die": (RUBBER, FLAT, ON_DIE + "TRACT  block 3 Y -5. weight\nTRACT  block 3 X 2.5 pull\n", 0.6),
    "on a body": (RUBBER, FLAT, ON_BODY + "TRACT  block 3 Y -5. weight\nTRACT  block 3 X -2.5 pull\n", 0.6),
    "between plates": (RUBBER, f"0. 0.   20*{ALONG[0]} 20*{ALONG[1]}   20*{ALONG[0]}-6*{ALONG[1]} 20*{ALONG[1]}+6*{ALONG[0]}   -6*{ALONG[1]} 6*{ALONG[0]}",
                       f"DIE    low\n   SEGM -20*{ALONG[0]} -20*{ALONG[1]}   60*{ALONG[0]} 60*{ALONG[1]}\nDIE    up PILOT 0. 6.\n"
                       f"   SEGM 60*{ALONG[0]}-6*{ALONG[1]} 60*{ALONG[1]}+6*{ALONG[0]}   -20*{ALONG[0]}-6*{ALONG[1]} 6*{ALONG[0]}-20*{ALONG[1]}\n"
                       f"CNT2D  block 1 low dry\nCNT2D  block 3 up dry\nMOVE   up X weight 0.01*{ALONG[1]}\nMOVE   up Y weight -0.01*{ALONG[0]}\n"
                       f"TRACT  block 2 X 20*{ALONG[0]} pull\nTRACT  block 2 Y 20*{ALONG[1]} pull\n", None)}


def slides(checks):
    """Bodies that slide away end with code 3 and are told as that, at the time of statics; a limit load is none."""
    for name, (law, corners, table, time) in SLIDES.items():
        run = Run(checks, "slides-" + name.replace(" ", "-"), RUBBED.format(law=law, corners=corners, table=table), NO_CONVERGENCE)
        if not run.ok:
            continue
        checks.that("block slides away: friction bears no more" in run.said, f"a block {name}: slides away", run.said)
        if time:
            checks.small(abs(run.history["time"][-1]/time - 1), 2e-3, f"a block {name}: when")
    run = Run(checks, "flows", RUBBED.format(law="EPLA\n   2000. 0.3\n   LINEAR 5. 0.", corners=FLAT, table=ON_DIE
                                            + "TRACT  block 3 Y -10. pull\nTRACT  block 3 X 0.1 weight\n"), NO_CONVERGENCE)
    if run.ok:
        checks.that("slides away" not in run.said and "a limit load (LOADF" in run.said, "a block pressed to its limit: no slide", run.said)


def warned_cycle(checks):
    """So has a cycle of contours, in what it prints first and in the summary at its end, which is that of a later mesh."""
    path, out = os.path.join(checks.folder, "contour.lag"), os.path.join(checks.folder, "contour")
    with open(path, "w", encoding="utf-8") as deck:
        deck.write(changed(checks, WRONG["contour out of reach"][0]))
    run = subprocess.run([LAGACYCLE, path, "--out", out], capture_output=True, text=True, check=False)
    if not checks.that(run.returncode == 0, "a cycle: ends with 0", run.stderr):
        return
    said = [line for line in run.stdout.splitlines() if "WARNING" in line]
    checks.that(len(said) == 1 and "does not meet the part" in said[0], "a cycle prints the warning once", run.stdout)
    with open(os.path.join(out, "summary.json"), encoding="utf-8") as summary:
        told = warnings_in(json.load(summary))
    checks.that(len(told) == 1 and "does not meet the part" in told[0]["text"], "the summary of a later mesh has the warning", told)


def idle(checks):
    """Dies that move and meet nothing: told at the end, and round-off is no error of the stress."""
    side = "DIE    side\n   SEGM  12. -5.   12. 20.\nCNT2D  billet 2 side -3 rough\nMOVE   side X press\n"
    run = Run(checks, "idle", changed(checks, {"1. -2.": "1. 2.", "FIXED  billet 4 X\n": "FIXED  billet 4 X\n" + side}))
    pushed = Run(checks, "ahead", changed(checks, {**WRONG["pushed from one side"][0], "PLSTN": "AXISYM", "-5. 15.": "0. 15."}))
    # the body is carried along, and does not come as far as the die that turns
    carried = Run(checks, "carried", changed(checks, {"FIXED  billet 4 X\n": "MOVE   billet 4 X press\n",
                                                      "30. 15.   -5. 15.": "30. 16.   -5. 16.", "MOVE   upper Y press": "MOVE   upper A press 0.01"}))
    if not (run.ok and pushed.ok and carried.ok):
        return
    for idle_run in (run, carried):
        with open(os.path.join(idle_run.out, "summary.json"), encoding="utf-8") as summary:
            told = warnings_in(json.load(summary))
        checks.that(len(told) == 1 and "against no resistance" in told[0]["text"], f"{idle_run.name}: dies without resistance, one warning", told)
    with open(os.path.join(pushed.out, "summary.json"), encoding="utf-8") as summary:
        found = json.load(summary)
    checks.that(len(warnings_in(found)) == 1 and found["accuracy"]["path"]["stress_pct"] == 0,
                "a body pushed ahead: the warning of its start, no error of the stress", (found["warnings"], found["accuracy"]))


CROSSED = """TITLE  A punch that goes into a block
STATE  PLSTN
KINEM  LOG
BLOCK  block PL8LS 4 steel
   0. 0.   10. 0.   10. 6.   0. 6.
   5 1.   4 1.
BLOCK  punch PL8LS 4 steel
   0. 8.   5. 8.   5. 14.   0. 14.
   3 1.   4 1.
LAW    steel ELA
   200000. 0.3
FIXED  block 1 Y
FIXED  block 4 X
FIXED  punch 4 X
LIC    press
   0. 0.   1. -5.
MOVE   punch 3 Y press
STRAT  0.1 1.E-4 0.5   4 3
END
"""


def crossed(checks):
    """A body that goes into another one without contact: told at the end, with the place; not where it stops before."""
    for way, wanted in (("-5.", 1), ("-1.9", 0)):
        run = Run(checks, "crossed" + way, CROSSED.replace("-5.", way))
        if not run.ok:
            return
        with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as summary:
            told = warnings_in(json.load(summary))
        checks.that(len(told) == wanted and all("block and punch have gone through each other, at x = 5, y = 6" in one["text"] for one in told),
                    f"a punch moved by {way}: {wanted} warning", told)


FULL = """TITLE  A billet in a container without an exit
STATE  AXISYM
KINEM  LOG
BLOCK  billet PL8LS 4 metal
   0. 0.   8. 0.   8. 10.   0. 10.
   4 1.   5 1.
LAW    metal EPLA
   70000. 0.33
   LINEAR 200. 200.
LAW    film COUL2D
   PENETR 1.E-3   PHI 0.1   AUGMENT 10
DIE    wall
   SEGM   10. -1.   10. 30.
DIE    punch PILOT 0. 10.
   SEGM   12. 10.   -1. 10.
CNT2D  billet 2 wall film
CNT2D  billet 3 2 punch film
FIXED  billet 1 Y
FIXED  billet 4 X
LIC    press
   0. 0.   1. -4.5
MOVE   punch Y press
STRAT  0.01 1.E-6 0.02   6 3
END
"""


def full(checks):
    """A billet of radius 8 and height 10 fills a bore of radius 10 at 3.6: told when it is pressed 4.5, with 1 - 5.5/6.4 = 14 % of its volume;
    not when it is pressed 3.4."""
    for way, told_of in (("-4.5", 1), ("-3.4", 0)):
        run = Run(checks, "full" + way, FULL.replace("-4.5", way))
        if not run.ok:
            return
        with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as summary:
            told = [one["text"] for one in warnings_in(json.load(summary))]
        checks.that(len(told) == told_of and all("billet has had hardly any room to flow since time 0.8" in text and "by up to 14 % of its volume" in text for text in told),
                    f"a container pressed by {way}: {told_of} warning", told)


def passed_planes(checks):
    """A corner that is moved behind the plane in which its body is held: told at the end, with the depth; not where it stays
    before it, nor where the side is clamped."""
    overhang = {"DIE    upper\n": "", "   SEGM  30. 15.   -5. 15.\n": "", "CNT2D  billet 3 upper -3 rough\n": "", "LAW    rough COUL2D\n": "",
                "   PENETR 1.E-3   PHI 0.3\n": "", "10. 0.   10. 15.": "5. 0.   10. 1.", "upper Y press": "POINT 10. 1. Y press"}
    # the same from the other side: held along y = 15
    hanging = {"10. 0.   10. 15.": "10. 14.   5. 15.", "upper Y press": "POINT 10. 14. Y press", "billet 1 Y": "billet 3 Y NOWALL"}
    overhang["billet 1 Y"] = "billet 1 Y NOWALL"
    for name, changes, behind in (("behind its plane", {"1. -2.": "1. -1.5"}, True), ("before its plane", {"1. -2.": "1. -0.9"}, False),
                                  ("above its plane", {**hanging, "1. -2.": "1. 1.5"}, True),
                                  ("above it by a hair", {**hanging, "1. -2.": "1. 1.005"}, False),
                                  ("clamped", {"1. -2.": "1. -1.5", "billet 1 Y": "billet 1 XY"}, False)):
        run = Run(checks, name.replace(" ", "-"), changed(checks, {**overhang, **changes}))
        if not run.ok:
            continue
        with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as summary:
            told = [warning["text"] for warning in warnings_in(json.load(summary))]
        plane, side = (15, 3) if "above" in name else (0, 1)
        words = f"has passed the plane y = {plane} in which it is held (FIXED billet.{side} Y), by 0.5"
        checks.that(len(told) == behind and all(words in text for text in told), f"{name}: told" if behind else f"{name}: nothing is told", told)


def worn(checks):
    """The first mesh of a contour whose REMSH has sizes alone: told where it has flowed far, with the error of its stress; not after a
    small stroke, nor where a row is a limit."""
    for name, way, rows, told_of in (("worn", "-9.", "   SIZE 2. 3.\n", 1), ("fresh", "-0.5", "   SIZE 2. 3.\n", 0),
                                     ("limited", "-9.", "   SIZE 2. 3.\n   SCALED 0.2\n", 0)):
        text = changed(checks, {**BODY, "1. -2.": "1. " + way})
        path, out = os.path.join(checks.folder, name + ".lag"), os.path.join(checks.folder, name)
        with open(path, "w", encoding="utf-8") as deck:
            deck.write(text.replace("REMSH\n", "REMSH\n" + rows))
        run = subprocess.run([LAGACYCLE, path, "--out", out], capture_output=True, text=True, check=False)
        if not checks.that(run.returncode == 0, f"{name}: ends with 0", run.stderr + run.stdout):
            continue
        with open(os.path.join(out, "summary.json"), encoding="utf-8") as summary:
            found = json.load(summary)
        told = [warning["text"] for warning in warnings_in(found) if "no row of REMSH is a limit" in warning["text"]]
        if not checks.that(len(told) == told_of, f"{name}: told {told_of} times", told) or told_of == 0:
            continue
        error = float(told[0].split("stress_error ")[1].split()[0])
        checks.small(abs(100*error/found["error"]["stress_pct"] - 1), 1e-3, f"{name}: the error of the stress")


def let_go(checks):
    """A billet between two dies, without supports: both go away; springs hold it."""
    free = {"FIXED  billet 1 Y\n": TABLE.replace("-1.", "0."), "FIXED  billet 4 X\n": "",
            "1. -2.": "0.4 -0.5   1. 2."}
    away = {"END\n": "MOVE   lower Y down\nLIC    down\n   0. 0.   0.4 0.   1. -2.\nEND\n"}
    for name, changes, told in (("both go away", {**free, **away}, True),
                                ("on springs", {**free, "END\n": "SPRNG  billet X 1.E-3\nSPRNG  billet Y 1.E-3\n" + away["END\n"]}, False)):
        run = Run(checks, name.replace(" ", "-"), changed(checks, changes))
        if not run.ok:
            continue
        with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as summary:
            said = [warning["text"] for warning in warnings_in(json.load(summary))]
        checks.that(len(said) == told and all("billet: at the end nothing holds it, no support and no contact (the nearest die" in text
                                              for text in said), f"{name}: told" if told else f"{name}: nothing is told", said)


PIN = """TITLE  A pin upset in a ring, the dies let them go
STATE  AXISYM
KINEM  LOG
BLOCK  pin PL8LS 4 soft
   0. 0.   4. 0.   4. 6.   0. 6.
   4 1.   6 1.
BLOCK  ring PL8LS 4 hard
   4.02 0.   8. 0.   8. 5.   4.02 5.
   4 1.   5 1.
LAW    soft EPLA
   70000. 0.33
   LINEAR 100. 200.
LAW    hard EPLA
   200000. 0.3
   LINEAR 300. 500.
LAW    film COUL2D
   PHI 0.1
DIE    low
   SEGM   -1. 0.   20. 0.
DIE    up PILOT 0. 6.
   SEGM   20. 6.   -1. 6.
DIE    bore SIDES ring 4
CNT2D  pin 1 low film
CNT2D  ring 1 low film
CNT2D  pin 3 up film
CNT2D  pin 2 bore film
FIXED  pin 4 X
LIC    go
   0. 0.   1. -0.6   1.3 0.
MOVE   up Y go
LIC    down
   0. 0.   1.05 0.   1.3 -1.
MOVE   low Y down
STRAT  0.02 1.E-6 0.03   5 3
END
"""


def let_go_together(checks):
    """A pin that has been upset in a ring holds it: together they rest where the dies have let them go, and have no errors of the motion
    by round-off of that."""
    run = Run(checks, "pin-and-ring", PIN)
    if not run.ok:
        return
    with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as summary:
        said = [warning["text"] for warning in warnings_in(json.load(summary))]
    checks.that(any(text.startswith("pin, ring: at the end nothing else holds them") for text in said), "pin and ring: told", said)
    checks.small(run.history["path_error_motion"][-1], 0.01, "pin and ring: error of the motion")


HEATED_STEEL = '''STEEL  base
SOURCE 'an example'
TEMPS  AC1 730 AC3 850 MS 300
MARTEN BETA 0.011
%sPHASE  ALL
   LAMBDA 30
   RHOC   4.5
END
'''
FURNACE = '''TITLE  A plate in a furnace
STATE  PLSTN
KINEM  SMALL
BLOCK  plate PL8TM 4 heat BILINEAR
   0. 0.   4. 0.   4. 1.   0. 1.
   4 1.   1 1.
LAW    heat META
   STEEL %s base
   ENERGY 1.
START  T %s
%sCONVE  plate 2 4 H 1. TS %s
STRAT  0.1 1.E-4 5.   5 3
STOP   100.
END
'''


def heated(checks):
    """Ferrite in a furnace at 900 degC; the same by a steel with AUSTEN; austenite that is quenched."""
    for name, card, begins, phases, ends, told in (
            ("without kinetics", "", 20.0, "START  PHASES FERRITE 1.\n", 900.0, True),
            ("with kinetics", "AUSTEN 5. 1.\n", 20.0, "START  PHASES FERRITE 1.\n", 900.0, False),
            ("below Ac1", "", 20.0, "START  PHASES FERRITE 1.\n", 700.0, False), ("quenched", "", 900.0, "", 20.0, False)):
        met = name.replace(" ", "-") + ".met"
        with open(os.path.join(checks.folder, met), "w", encoding="utf-8") as file:
            file.write(HEATED_STEEL % card)
        run = Run(checks, name.replace(" ", "-"), FURNACE % (met, begins, phases, ends))
        if not run.ok:
            continue
        with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as summary:
            said = [warning["text"] for warning in warnings_in(json.load(summary))]
        checks.that(len(said) == told and all("which has no kinetics of austenite (AUSTEN): 100 %" in text for text in said),
                    f"{name}: told" if told else f"{name}: nothing is told", said)


HELD_STEEL = '''STEEL  base
SOURCE 'an example'
TEMPS  MS 300
MARTEN BETA 0.011
CCT
   0.1  700 0 0 0
   0.1  600 0.8 0 0
   10   700 0 0 0
   10   600 0.1 0 0
PHASE  ALL
   LAMBDA 30
   RHOC   4.5
END
'''


def held(checks):
    """A steel of a CCT diagram held at 650 degC for 600 s, where its slowest history forms 0.08 % in a second; after a fast cooling held
    for 50 s, where the fastest forms the 9 % that it has to come within 9 s, and the slowest 0.08 % in each of the others; cooled as the
    diagram says; cooled more slowly than its slowest history, by which all that this forms is there in the end."""
    with open(os.path.join(checks.folder, "held.met"), "w", encoding="utf-8") as file:
        file.write(HELD_STEEL)
    for name, way, told in (("held", "0. 800.   30. 650.   630. 650.   720. 200.", "48 %"), ("soon", "0. 800.   11. 690.   61. 690.   71. 590.", "12 %"),
                            ("cooled", "0. 800.   120. 200.", ""), ("slowly", "0. 800.   6000. 500.", "")):
        deck = FURNACE % ("held.met", "800.", "IMPOS  plate 1 2 3 4 T way\nLIC    way\n   " + way + "\n", "20.")
        run = Run(checks, name, deck.replace("CONVE  plate 2 4 H 1. TS 20.\n", "").replace("STOP   100.", f"STOP   {way.split()[-2]}"))
        if not run.ok:
            continue
        with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as summary:
            said = [warning["text"] for warning in warnings_in(json.load(summary))]
        checks.that(len(said) == bool(told) and all(f"up to {told} that its histories form in the time have not" in text for text in said),
                    f"{name}: told" if told else f"{name}: nothing is told", said)


def small(checks):
    """SMALL ends where strains are large."""
    half = changed(checks, {"KINEM  LOG": "KINEM  SMALL", "1. -2.": "1. -9."})
    for name, text, words in (("upset by 60 %", half, "KINEM LOG"), ("locking", SPHERE, "MEAN")):
        path = os.path.join(checks.folder, name.replace(" ", "-").replace("%", "percent") + ".lag")
        with open(path, "w", encoding="utf-8") as deck:
            deck.write(text)
        run = subprocess.run([LAGAMINE, path, "--out", path[:-4], "--quiet"], capture_output=True, text=True, check=False)
        print(f"{name:28s} {run.stderr.splitlines()[0] if run.stderr else ''}")
        checks.that(run.returncode == NO_CONVERGENCE, f"{name}: ends with 3", run.returncode)
        checks.that("large strain in KINEM SMALL" in run.stderr and words in run.stderr, f"{name}: the words for it", run.stderr)


def probes(checks):
    """Measures of stress are those of the components; nodes of two bodies at one place are told apart."""
    run = Run(checks, "probes", changed(checks, {"END\n": PROBES + "END\n"}))
    if not run.ok:
        return
    table = run.history
    for k in (0, -1):
        s = np.array([[table["xx"][k], table["xy"][k], 0], [table["xy"][k], table["yy"][k], 0], [0, 0, table["zz"][k]]])
        size = np.abs(s).max()
        deviator = s - np.trace(s)/3*np.eye(3)
        checks.small(abs(table["q"][k] - np.sqrt(1.5*np.sum(deviator**2)))/size, 1e-12, "mises")
        checks.small(abs(table["m"][k] - np.trace(s)/3)/size, 1e-12, "mean_stress")
        found = [table[name][k] for name in ("p1", "p2", "p3")]
        checks.small(np.max(np.abs(np.linalg.eigvalsh(s)[::-1] - found))/size, 1e-12, "principal stresses")
        checks.that(table["most"][k] >= table["q"][k] and table["least"][k] <= table["p3"][k], "extremes")
        checks.that(abs(table["one"][k]) > 0 and not abs(table["two"][k]) > 0, "nodes of two bodies", (table["one"][k], table["two"][k]))


def main():
    checks = Checks()
    decks(checks)
    warned_run(checks)
    stopped_run(checks)
    slides(checks)
    free_dies(checks)
    warned_cycle(checks)
    idle(checks)
    crossed(checks)
    full(checks)
    passed_planes(checks)
    worn(checks)
    let_go(checks)
    let_go_together(checks)
    heated(checks)
    held(checks)
    small(checks)
    probes(checks)
    checks.end()


if __name__ == "__main__":
    main()

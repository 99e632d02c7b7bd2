# SPDX-License-Identifier: Apache-2.0
"""The methods that are compared, and the switches that set one source of error to its reference. A line each: to compare
another method, add a line. A line whose options this build lacks is left out and named in the report."""
from dataclasses import dataclass


@dataclass(frozen=True)
class Method:
    name: str           # in legends and tables
    arguments: tuple    # of heliopolis-bake
    values: tuple = ()  # of the option, from few links to many; () = steps from the method's own default both ways
    scenes: tuple = ()  # only these; () = all
    option: str = "--epsilon"


BEST = "Heliopolis"
PAPER_FACTORS = (0.3, 0.1, 0.03, 0.01, 0.003, 0.001)

METHODS = (
    Method(BEST, ()),
    Method("by --error", (), (0.16, 0.08, 0.04, 0.02, 0.01, 0.005), ("S", "M", "dense"), "--error"),
    Method("receivers: patches alone", ("--receivers", "patches"), scenes=("S", "M", "dense")),
    Method("patches not split", ("--split", "1"), scenes=("S",)),
    Method("constant senders", ("--senders", "constant"), scenes=("S", "M", "dense")),
    Method("free rectangle tree", ("--tree", "free"), scenes=("S", "M")),
    Method("quadtree (HSA91)", ("--tree", "faces", "--senders", "constant"), scenes=("S", "M", "dense")),
    Method("paper, repaired, no cut-off", ("--method", "paper", "--cutoff", "0"), PAPER_FACTORS, ("S", "M", "dense")),
    Method("paper, repaired, cut-off 30 m", ("--method", "paper", "--cutoff", "30"), PAPER_FACTORS, ("S", "M", "dense")),
    Method("paper, as printed", ("--method", "paper-literal", "--cutoff", "30"), PAPER_FACTORS, ("S", "M")),
)


@dataclass(frozen=True)
class Switch:
    """One source of error set to its reference. "@" in render: a table of the pack's own direct light by rays."""
    name: str
    bake: tuple = ()
    render: tuple = ()
    finer: float = 0.0  # --epsilon = this x the threshold that the default bake used


SWITCHES = (
    Switch("default"),
    Switch("visibility: 64 rays a link", bake=("--link-rays", "64")),
    Switch("form factors and far field: threshold / 8", finer=0.125),
    Switch("both of them", bake=("--link-rays", "64"), finer=0.125),
    Switch("patch size and threshold: a quarter of the error", bake=("--error", "0.005")),
    Switch("patch size, threshold and visibility", bake=("--error", "0.005", "--link-rays", "64")),
    Switch("sky view: 8192 rays a patch", bake=("--rays", "8192")),
    Switch("sun raster: texels of 0.02 m", render=("--sun-texel", "0.02")),
    Switch("sun and sky by rays (--first-light)", render=("--first-light", "@")),
    Switch("iterations: residual 1e-6", render=("--residual", "1e-6")),
    Switch("all but patch size", bake=("--link-rays", "64"), finer=0.125,
           render=("--first-light", "@", "--residual", "1e-6")),
    Switch("all", bake=("--error", "0.005", "--link-rays", "64"), render=("--first-light", "@", "--residual", "1e-6")),
)

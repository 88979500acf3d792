"""The ordinary jobs as data: what is run, and what must come of it. Each is NAME.geo and NAME.yaml beside this file, as
a user would write them: the scenes have no keys of the numerics. Each geometry has a parameter `refine` that divides
all its element sizes; at 1 it is the mesh of the job."""
from dataclasses import dataclass, field


@dataclass
class Answer:
    """A probe at the end of the run and its reference."""
    probe: str
    reference: float
    error: float  # of the reference, per cent
    source: str  # closed form, CalculiX, or limit: Richardson's of refined meshes and a stiff penalty
    tolerance: float = 2.0  # per cent


@dataclass
class Job:
    name: str
    what: str
    answers: list
    steps: int  # at most so many
    pairs: int = 1  # contact pairs of the scene
    shown: str = "von_mises"  # field of the picture
    picture: list = field(default_factory=list)  # options of scripts/render.py
    levels: tuple = (1, 2, 4)  # values of `refine` whose answers run.py --limit extrapolates
    stiff: list = field(default_factory=list)  # overrides of those runs


FAILED = 0.1  # largest part of the attempted steps that may fail

JOBS = [
    # Rubber
    # Balls
    Job("ball_in_cone", "ball in a cone by force", [
        Answer("peak_pressure", 83.00, 0.1, "limit"),  # Hertz, for a ring of infinite radius: 84.42
        Answer("ball_down", -0.031926, 0.05, "limit"),
    ], steps=20, picture=["--mirror", "x"]),
    # Machine parts
]

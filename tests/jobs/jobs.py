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
    levels: tuple = (1, 1.5, 2.25)  # values of `refine` whose answers run.py --limit extrapolates
    stiff: list = field(default_factory=list)  # overrides of those runs


FAILED = 0.1  # largest part of the attempted steps that may fail

JOBS = [
    # Rubber
    Job("lip_seal", "lip seal on a shaft", [
        Answer("radial_force", 1, 0, "limit"),
        Answer("lip_up", 1, 0, "limit"),
    ], steps=30, picture=["--mirror", "x"]),
    Job("wheel_on_edge", "rubber wheel on an edge", [
        Answer("down", 1, 0, "limit"),
        Answer("sideways", 1, 0, "limit"),
    ], steps=30),
    Job("rollers_in_nip", "rubber-covered rollers in a nip", [
        Answer("force", 1, 0, "limit"),
        Answer("half_width", 1, 0, "limit"),
        Answer("peak_pressure", 1, 0, "limit"),
    ], steps=30, picture=["--mirror", "x"]),
    Job("tube_on_barb", "tube pushed over a barbed nipple", [
        Answer("grip", 1, 0, "limit"),
        Answer("push", 1, 0, "limit"),
    ], steps=100, picture=["--mirror", "x"]),
    Job("bush_turned", "bush turned and pushed", [
        Answer("force_x", 1, 0, "limit"),
        Answer("force_y", 1, 0, "limit"),
    ], steps=30, pairs=2),
    Job("boot_on_mandrel", "boot closed onto a mandrel", [
        Answer("radial_force", 1, 0, "limit"),
        Answer("push", 1, 0, "limit"),
    ], steps=50, picture=["--mirror", "x"]),
    # Balls
    Job("ball_in_cone", "ball in a cone by force", [
        Answer("peak_pressure", 83.00, 0.1, "limit"),  # Hertz, for a ring of infinite radius: 84.42
        Answer("ball_down", -0.031926, 0.05, "limit"),
    ], steps=20, picture=["--mirror", "x"]),
    Job("ball_in_vee", "ball in a vee groove", [
        Answer("peak_pressure", 1, 0, "limit"),
        Answer("ball_down", 1, 0, "limit"),
    ], steps=30),
    # Machine parts
]

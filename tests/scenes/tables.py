"""Histories and yield curves from files of comma-separated values: a block that a load, an imposed displacement and a
tool move along a table, in the plane, around an axis and in 3D, against the numbers of the table; what is no table is
refused with file and line; a restart needs no file."""
import pathlib
import re
import subprocess

import numpy

from harness import Check, Run, arguments, run, SCENES

E = 1000
TIMES, FACTORS = (0, 2, 5, 10), (0, 1, -0.5, 0.75)
TABLE = "\ufeff# of the test bench\r\ntime;way;\"force\"\r\n" + "".join(
    f"{t}; 7 ;{f:.3e}\r\n" for t, f in zip(TIMES, FACTORS))
PLAIN = "\n".join(f"{t / 10},{f}" for t, f in zip(TIMES, FACTORS))
MATERIAL = "bodies.0.material={law: linear, E: 1000, nu: 0}"
STEPS = "stepping={control: fixed, initial: 0.05}"
GEOMETRIES = {
    "solid": (SCENES / "patch.yaml", ("y_min", "y_max"), 3.0, 1.0),
    "plane_strain": (SCENES / "patch_plane.yaml", ("y_min", "y_max"), 2.0, 1.0),
    "axisymmetric": (SCENES / "patch_plane.yaml", ("y_min", "y_max"), numpy.pi * 4, 1.0)
}


def expected(steps):
    return numpy.interp([row["t"] for row in steps], numpy.array(TIMES) / 10, FACTORS)


def near(what, steps, name, scale, allowed=1e-8):
    check.near(what, numpy.array([row[name] for row in steps]) / scale, expected(steps), allowed)


def block(geometry):
    scene, (low, high), area, height = GEOMETRIES[geometry]
    dim = 3 if geometry == "solid" else 2
    along = [0.0] * dim
    along[1] = 6.0
    common = [
        f"geometry={geometry}", "kinematics=small", MATERIAL, STEPS, f"supports=[{{surface: {low}, uy: 0}}]",
        f"probes=[{{name: force, reaction: {low}, component: y}}]"
    ]
    for d in range(dim):
        if d != 1 and geometry != "axisymmetric":
            common.append(f"supports.0.u{'xyz'[d]}=0")
    finished = run(args, scene, out=f"traction_{geometry}", overrides=[
        *common, f"loads=[{{surface: {high}, traction: {along}, history: {{csv: {folder}/table.csv, column: force, "
        "end: 10}}]"
    ])
    near(f"{geometry}: force of a traction along the table", finished.steps(), "force", -6 * area)
    finished = run(args, scene, out=f"way_{geometry}", overrides=[
        *common, f"loads=[{{surface: {high}, uy: 0.01, history: {{csv: {folder}/plain.csv}}}}]"
    ])
    near(f"{geometry}: force of a displacement along the table", finished.steps(), "force", -0.01 * E / height * area)


def tool():
    """A plane is pressed onto the block as the table says, in a scene beside its table."""
    scene = folder / "tool.yaml"
    text = (SCENES / "patch.yaml").read_text().replace("../../meshes", str((SCENES / "../../meshes").resolve()))
    scene.write_text(text)
    finished = run(args, scene, out="tool", overrides=[
        "kinematics=small", MATERIAL, STEPS, "supports=[{surface: y_min, ux: 0, uy: 0, uz: 0}]",
        "contact=[{name: pair, slave: y_max, penalty: {initial: 1e6, scale: 1}, master: {plane: {point: [0, 1, 0], "
        "normal: [0, -1, 0], motion: [{uy: -0.01, history: {csv: press.csv, column: 2, end: 10}}]}}}]",
        "probes=[{name: force, contact_force: pair, component: y}]"
    ])
    t = numpy.array([row["t"] for row in finished.steps()])
    spring = 1 / (1 / E + 1 / 1e6)  # per area: block and penalty in series
    exact = 0.01 * numpy.interp(t, [0, 0.4, 1], [0, 1, 0.5]) * spring * 3
    found = numpy.array([row["force"] for row in finished.steps()])
    check.near("a tool along a table beside the scene", numpy.abs(found) / exact.max(), exact / exact.max(), 1e-3)
    return finished


def restart():
    """The checkpoint has the numbers: the table is not needed any more, and another one is another scene."""
    scene = folder / "tool.yaml"
    directory = folder / "again"
    table = "0 0\n0.25 0\n1 0.75\n"
    options = [
        "-set", "stepping={control: fixed, initial: 0.25, dt_min: 0.2, damping: none}", "-set",
        "supports=[{surface: y_min, ux: 0, uy: 0, uz: 0}]", "-set",
        "loads=[{surface: y_max, traction: [0, 6, 0], history: {csv: again.csv}}]", "-set",
        "probes=[{name: force, reaction: y_min, component: y}]"
    ]
    (folder / "again.csv").write_text(table)
    run(args, scene, *options, "-set", "solver.max_iterations=1", out="again", must=2)
    (folder / "again.csv").write_text(table.replace("0.75", "0.5"))
    other = run(args, scene, *options, out="again", keep=True, must=1)
    check.holds("another table is another scene", "results of another scene" in other.text, other.text.strip()[-200:])
    (folder / "again.csv").unlink()
    command = [args.burnish, "-restart", str(directory), "-set", "solver.max_iterations=30"]
    if args.ranks > 1:
        command = ["mpirun", "-n", str(args.ranks), *command]
    finished = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    check.holds("a restart reads no table", finished.returncode == 0, finished.stdout if finished.returncode else "")
    last = Run(0, "", directory).steps()[-1]
    check.near("its last force", last["force"], -0.75 * 6 * 3, 1e-8)


def hardened(table, ranks):
    """The force of a block that yields by a curve."""
    finished = run(args, SCENES / "patch.yaml", out="hardening", ranks=ranks, overrides=[
        "kinematics=small", f"bodies.0.material={{law: von_mises, E: 1000, nu: 0.3, hardening: {{table: {table}}}}}",
        "supports=[{surface: y_min, ux: 0, uy: 0, uz: 0}]", "loads=[{surface: y_max, uy: 0.05}]",
        "probes=[{name: force, reaction: y_min, component: y}]", "stepping={control: fixed, initial: 0.25}"
    ])
    return finished.summary()["probes"]["force"]


def hardening():
    """A yield curve from a file gives the stress of the same curve in the scene: to the last bit on one rank. On several
    the direct solver sums what comes in first, and two runs of one scene differ by rounding."""
    (folder / "yield.csv").write_text("strain,stress\n0,10\n0.01,12\n0.1,20\n")
    here, file = "[[0, 10], [0.01, 12], [0.1, 20]]", f"{{csv: {folder}/yield.csv}}"
    alone = hardened(here, 1)
    check.near("yield curve of a file", hardened(file, 1), alone, 0)
    if args.ranks > 1:
        check.near(f"the same on {args.ranks} ranks", hardened(file, args.ranks), alone, 1e-12 * abs(alone))


REFUSED = {  # text -> what the map says besides the file -> what the message matches
    "word": ("t,f\n0,1\n0.5,much\n1,2\n", "", r"bad\.csv:3: the row has a field that is no number.*loads\.0\.history"),
    "comma": ("t;f\n0;1\n0,5;2\n1;2\n", "", r"bad\.csv:3: the row has a field that is no number.*with a point"),
    "order": ("0,1\n0.5,2\n0.4,3\n", "", r"bad\.csv:3: 0\.4 does not increase"),
    "start": ("0.1,1\n0.5,2\n", "", r"bad\.csv:1: 0\.1 is the first value.*allowed: 0"),
    "beyond": ("0,1\n5,2\n", "", r"bad\.csv:2: 5 is beyond t = 1.*`end:`"),
    "short": ("0,1\n0.5,2\n1\n", "", r"bad\.csv:3: the row has too few columns"),
    "one": ("0,1\n", "", r"bad\.csv:\d+: the table ends with less than two rows"),
    "name": ("t,f\n0,1\n1,2\n", ", column: way", r"bad\.csv:1: way is no column of the head"),
    "head": ("0,1\n1,2\n", ", column: way", r"bad\.csv:1: way is named as a column, but the file has no head"),
    "key": ("0,1\n1,2\n", ", col: 2", r"loads\.0\.history: unknown key col; allowed: csv, column, over, end"),
    "column": ("0,1\n1,2\n", ", column: 0", r"loads\.0\.history: column is no column; allowed: its number, from 1"),
    "end": ("0,1\n1,2\n", ", end: 0", r"loads\.0\.history: end is no number above 0"),
    "binary": ("0,1\0\n1,2\n", "", r"bad\.csv: has a zero character"),
    "none": (None, "", r"bad\.csv: cannot be read .*allowed: a table of comma-separated values.*B104"),
}


def refusals():
    bad = folder / "bad.csv"
    for name, (text, more, message) in REFUSED.items():
        bad.unlink(missing_ok=True)
        if text is not None:
            bad.write_text(text)
        finished = run(args, SCENES / "patch.yaml", "-check", out="refused", must=None, overrides=[
            "supports=[{surface: y_min, ux: 0, uy: 0, uz: 0}]",
            f"loads=[{{surface: y_max, uy: 0.01, history: {{csv: {bad}{more}}}}}]"
        ])
        refused = finished.status == 1 and re.search(message, finished.text)
        check.holds(f"refused: {name}", refused, finished.text.strip())


args = arguments()
check = Check()
folder = pathlib.Path(args.out).resolve() / "tables"
folder.mkdir(parents=True, exist_ok=True)
args.out = str(folder)
(folder / "table.csv").write_text(TABLE, newline="")
(folder / "plain.csv").write_text(PLAIN)
(folder / "press.csv").write_text("t, way\n0, 0\n4, 1\n10, 0.5\n")
for form in GEOMETRIES:
    block(form)
tool()
hardening()
restart()
if args.ranks == 1:
    refusals()
check.finish()

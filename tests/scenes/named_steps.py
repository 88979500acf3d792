"""Steps with names: loads, springs, displacements and tools that come and go, in the plane, about an axis and in 3D,
against closed forms; results and log name the steps; a restart knows them; what cannot be is refused."""
import re
import subprocess

import h5py
import numpy

from harness import Check, Run, arguments, run, SCENES

E, BED = 1000, 500
STEPS = "[{name: close, until: 0.2}, {name: hold, until: 0.5}, {name: open, until: 0.6}, {name: push, until: 1}]"
STEPPING = f"stepping={{control: fixed, initial: 0.05, steps: {STEPS}}}"
MATERIAL = "bodies.0.material={law: linear, E: 1000, nu: 0}"
GEOMETRIES = {
    "solid": (SCENES / "patch.yaml", 3.0),
    "plane_strain": (SCENES / "patch_plane.yaml", 2.0),
    "axisymmetric": (SCENES / "patch_plane.yaml", numpy.pi * 4)
}
# what acts over t
EARLY = ([0, 0.2, 0.5, 0.6, 1], [0, 1, 1, 0, 0])  # during: [close, hold]
LATE = ([0, 0.6, 1], [0, 0, 1])  # during: push
BED_IS_THERE = ([0, 0.5, 0.6, 1], [1, 1, 2, 2])  # a bed of the start, and another one that comes in `open`


def columns(finished, *names):
    steps = finished.steps()
    return [numpy.array([row[name] for row in steps]) for name in ("t", *names)]


def block(geometry):
    """Two tractions and two beds. Exact: block and beds in series."""
    scene, area = GEOMETRIES[geometry]
    dim = 3 if geometry == "solid" else 2
    vector = lambda value: [0.0, value, 0.0][:dim]
    side = [100.0, 0.0, 100.0][:dim] if geometry != "axisymmetric" else None
    finished = run(args, scene, out=f"block_{geometry}", overrides=[
        f"geometry={geometry}", "kinematics=small", MATERIAL, STEPPING,
        f"supports=[{{surface: y_min, spring: {vector(BED)}}}, {{surface: y_min, spring: {vector(BED)}, during: "
        "[open, push]}]", *([f"supports.2={{surface: y_min, spring: {side}}}"] if side else []),
        f"loads=[{{surface: y_max, traction: {vector(-6)}, during: [close, hold]}}, "
        f"{{surface: y_max, traction: {vector(-3)}, during: push}}]",
        "probes=[{name: bed, reaction: y_min, component: y}, {name: top, displacement: "
        f"{[0, 1, 0][:dim]}, component: y}}]"
    ])
    t, bed, top = columns(finished, "bed", "top")
    load = 6 * numpy.interp(t, *EARLY) + 3 * numpy.interp(t, *LATE)
    exact = -load * (1 / E + 1 / (BED * numpy.interp(t, *BED_IS_THERE)))
    check.near(f"{geometry}: force of the beds", bed / area, load, 1e-7)
    check.near(f"{geometry}: displacement", top / 0.018, exact / 0.018, 1e-8)
    return finished


def motions():
    """A displacement stays after its step; a plane is pushed in the last step by a motion, and its force goes."""
    finished = run(args, SCENES / "patch.yaml", out="motions", overrides=[
        "kinematics=small", MATERIAL, STEPPING, "supports=[{surface: y_min, ux: 0, uy: 0, uz: 0}]",
        "contact=[{name: pair, slave: "
        "y_max, penalty: {initial: 1e6, scale: 1}, master: {plane: {point: [0, 1, 0], normal: [0, -1, 0], motion: "
        "[{uy: -0.01, during: [close, hold]}, {uy: 0.005, during: push}]}}}]",
        "probes=[{name: force, contact_force: pair, component: y}]"
    ])
    t, force = columns(finished, "force")
    way = 0.01 * numpy.interp(t, [0, 0.5, 1], [0, 1, 1]) - 0.005 * numpy.interp(t, [0, 0.6, 1], [0, 0, 1])
    exact = 3 * way / (1 / E + 1 / 1e6)
    check.near("tool: force", numpy.abs(force) / exact.max(), exact / exact.max(), 1e-8)
    finished = run(args, SCENES / "patch.yaml", out="way", overrides=[
        "kinematics=small", MATERIAL, STEPPING, "supports=[{surface: y_min, ux: 0, uy: 0, uz: 0}]",
        "loads=[{surface: y_max, uy: -0.01, during: [close, hold]}]",
        "probes=[{name: force, reaction: y_min, component: y}]"
    ])
    t, force = columns(finished, "force")
    check.near("displacement: force", force / 30, numpy.interp(t, [0, 0.5, 1], [0, 1, 1]), 1e-8)


def names(finished):
    """The names are in the log, in steps.csv, in summary.json and in results.h5."""
    steps = finished.steps()
    expected = ["close" if s["t"] <= 0.2 else "hold" if s["t"] <= 0.5 else "open" if s["t"] <= 0.6 else "push"
                for s in steps]
    check.holds("steps.csv names the steps", [s["during"] for s in steps] == expected)
    check.holds("summary.json does", finished.summary()["during"] == "push")
    check.holds("the log does", "step 'close' has ended, 'hold' begins" in finished.text)
    with h5py.File(finished.directory / "results.h5", "r") as file:
        found = [file["steps"][group].attrs["during"].decode() for group in sorted(file["steps"])]
    check.holds("results.h5 does", found == expected, "" if found == expected else str(found))
    checked = run(args, SCENES / "patch.yaml", "-check", out="check", overrides=[
        STEPPING, "supports=[{surface: y_min, ux: 0, uy: 0, uz: 0}]",
        "loads=[{surface: y_max, uy: -0.01, during: [close, hold]}]"
    ])
    check.holds("-check lists them", re.search(r"'hold' from t = 0.2 to 0.5: loads.0", checked.text))


def restart():
    """A run that ends in the second step goes on with the steps; they cannot be changed then."""
    overrides = [
        "stepping={control: fixed, initial: 0.1, dt_min: 0.09, damping: none, steps: [{name: rest, until: 0.3}, "
        "{name: pull, until: 1}]}", "supports=[{surface: y_min, ux: 0, uy: 0, uz: 0}]",
        "loads=[{surface: y_max, traction: [0, 6, 0], during: pull}]",
        "probes=[{name: force, reaction: y_min, component: y}]"
    ]
    first = run(args, SCENES / "patch.yaml", out="restart", must=2, overrides=[*overrides, "solver.max_iterations=1"])
    check.holds("the first part ends where the load begins", first.summary()["during"] == "rest")

    def go_on(*options):
        command = [args.burnish, "-restart", str(first.directory)]
        for option in options:
            command += ["-set", option]
        if args.ranks > 1:
            command = ["mpirun", "-n", str(args.ranks), *command]
        return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    other = go_on("stepping.steps.0.until=0.5")
    check.holds("steps are not changed in a restart",
                other.returncode == 1 and "histories of loads follow from steps" in other.stdout, other.stdout)
    second = go_on("solver.max_iterations=30")
    check.holds("the second part ends", second.returncode == 0, second.stdout if second.returncode else "")
    steps = Run(0, "", first.directory).steps()
    t = numpy.array([row["t"] for row in steps])
    check.near("force of both parts", numpy.array([row["force"] for row in steps]) / -18,
               numpy.interp(t, [0, 0.3, 1], [0, 0, 1]), 1e-8)
    check.holds("names of both parts", [row["during"] for row in steps] == ["rest" if x <= 0.3 else "pull" for x in t])


args = arguments()
check = Check()
for form in GEOMETRIES:
    result = block(form)
motions()
names(result)
restart()
check.finish()

"""Units of the scene in the last screen, summary.json, -check and pictures; what forces are meant of."""
import math
import pathlib
import subprocess
import sys

from harness import Check, arguments, run, SCENES

SCRIPTS = SCENES / "../../scripts"
UNITS = "units={length: mm, force: N, stress: MPa}"
PROBES = {
    "force": ("reaction: y_min, component: y", "N"),
    "contact": ("contact_force: pair, component: y", "N"),
    "drag": ("friction_force: pair, component: x", "N"),
    "torque": ("friction_torque: pair", "N mm"),
    "held": ("reaction_torque: y_min", "N mm"),
    "twist": ("contact_torque: pair", "N mm"),
    "area": ("slipped_area: pair", "mm^2"),
    "pressed": ("contact_area: pair", "mm^2"),
    "way": ("tool_motion: pair, component: y", "mm"),
    "peak": ("pressure_max: pair", "MPa"),
    "spread": ("pressure_deviation: pair", "per cent")
}
PER_THICKNESS = {
    "force": "N/mm",
    "contact": "N/mm",
    "drag": "N/mm",
    "torque": "N mm/mm",
    "held": "N mm/mm",
    "twist": "N mm/mm",
    "area": "mm",
    "pressed": "mm"
}

TORQUES = ("torque", "held", "twist")

# Of the surface y_max of the block of 2 x 1 x 1.5; of the plane 2 x 1 per thickness, or about the axis x = 0.
AREAS = {"solid": 3, "plane": 2, "thick": 6, "axisymmetric": 4 * math.pi}


def pressed(name, *overrides, dim=2, **options):
    point, normal = ("[0, 1, 0]", "[0, -1, 0]") if dim == 3 else ("[0, 1]", "[0, -1]")
    held = "ux: 0, uy: 0" + (", uz: 0" if dim == 3 else "")
    torque = ", axis: y" if dim == 3 else ""
    kept = [key for key in PROBES if not (key in (*TORQUES, "drag") and "axisymmetric" in name)]
    probes = ", ".join(f"{{name: {key}, {PROBES[key][0]}{torque if key in TORQUES else ''}}}" for key in kept)
    return run(args, SCENES / ("patch.yaml" if dim == 3 else "patch_plane.yaml"), *options.get("options", ()), out=name,
               overrides=["kinematics=small", "solver.tolerance=1e-8", f"supports=[{{surface: y_min, {held}}}]",
                          "contact=[{name: pair, slave: y_max, friction: {mu: 0.1}, master: {plane: {point: " + point +
                          ", normal: " + normal + ", motion: [{uy: -0.01}]}}}]", f"probes=[{probes}]", *overrides])


def geometries():
    for name, dim, overrides, forces, special in (
        ("solid", 3, [], "of the model", {}),
        ("plane", 2, [], "per mm of thickness", PER_THICKNESS),
        ("thick", 2, ["thickness=3"], "on a thickness of 3 mm", {}),
        ("axisymmetric", 2, ["geometry=axisymmetric"], "over 360 degrees", {}),
    ):
        finished = pressed(name, UNITS, *overrides, dim=dim)
        units = finished.summary()["units"]
        check.holds(f"{name}: forces", units["forces"] == forces, units["forces"])
        area = finished.summary()["probes"]["pressed"]
        check.holds(f"{name}: the whole surface is in contact", abs(area / AREAS[name] - 1) < 1e-9, area)
        for key, unit in units["probes"].items():
            check.holds(f"{name}: {key}", unit == special.get(key, PROBES[key][1]), unit)
        check.holds(f"{name}: the last screen", any(
            line.startswith("peak ") and line.endswith(" MPa") for line in finished.text.splitlines()))
    checked = pressed("check", UNITS, options=("-check",))
    check.holds("-check", "units    length mm, force N, stress MPa; forces per mm of thickness" in checked.text)
    plain = pressed("plain")
    steps = pressed("steps", UNITS, "stepping={steps: [{name: press, until: 0.5}, {name: rest, until: 1}]}")
    for script in ("report.py", "plot.py"):
        made = subprocess.run([sys.executable, SCRIPTS / script, str(steps.directory)], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)
        check.holds(f"{script} of a run with named steps", made.returncode == 0, made.stdout[-300:])
    check.holds("without the key", plain.summary()["units"]["probes"]["force"] == "force/length"
                and not plain.summary()["units"]["named"])
    check.holds("the last screen has no unit then", not any(
        line.startswith("peak ") and len(line.split()) > 2 for line in plain.text.splitlines()))


def pictures():
    folder = pathlib.Path(args.out) / "plane"
    for command in (["plot.py", folder, "-o", folder / "curves.png"],
                    ["plot.py", folder, "--x", "way", "-o", folder / "x.png"], ["report.py", folder],
                    ["render.py", folder, "--field", "pressure"], ["render.py", folder, "--field", "status"]):
        finished = subprocess.run([sys.executable, SCRIPTS / command[0], *map(str, command[1:])],
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        check.holds(f"{command[0]} {command[-1]}", finished.returncode == 0, finished.stdout[-300:])


args = arguments()
check = Check()
geometries()
pictures()
check.finish()

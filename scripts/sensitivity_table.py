"""Derivatives of probes by numbers of the scene against central differences of whole runs. Leaves one record per probe
and number and prints the table; --print tables an existing record, --only runs some scenes.
    python scripts/sensitivity_table.py [--burnish BINARY] [--record FILE] [--only NAME ...]
Runs are solved to a residual of 1e-12. The differences are those between 1e-4 more and 1e-4 less of the number, and
between half of that, from which the error of second order is extrapolated. Penalties are fixed, as the run holds their
factors when it differentiates. The runs of the differences are asked for the derivative, too, so that their contact
lists are those of the solution."""
import csv
import shutil
import subprocess

from launch import ROOT, command, environment, fill_scenes, read_summary

STEP = 1e-4
COLUMNS = ("scene", "probe", "key", "way", "value", "derivative", "difference", "deviation", "cpu_s", "solve_cpu_s")
TIGHT = ("solver.tolerance=1e-12", "solver.max_iterations=60")


class Case:
    """A scene, its edits, and of each probe the keys by which it is differentiated."""

    def __init__(self, scene, edits, **wanted):
        self.scene, self.edits, self.wanted = scene, edits, wanted


STEPS = "stepping={control: fixed, initial: 0.1}"
FIXED = "contact.0.penalty={initial: auto, scale: 50}"
CASES = {
    "punch":
    Case("runs/punch.yaml", ("mesh.parameters.n=2", "bodies.0.material.nu=0.45"), force=("bodies.0.material.E=3",
                                                                                      "loads.0.uy=-0.1")),
    "ring_pinch":
    Case("runs/ring_pinch.yaml", ("bodies.0.formulation=full", "mesh.order=2"),
         force=("bodies.0.material.nu=0.3", "mesh.parameters.r_in=99"), width=("loads.0.uy=-50", )),
    "hertz_line":
    Case("runs/hertz_line.yaml", ("mesh.parameters.h=0.8", "loads=[{surface: cylinder_cut, uy: -0.3}]", FIXED),
         force=("bodies.1.material.E=70000", "loads.0.uy=-0.3", "contact.0.penalty.scale=50"),
         peak_pressure=("bodies.0.material.nu=0.3", )),
    "o_ring":
    Case("runs/o_ring.yaml", ("mesh.parameters.n=6", FIXED, FIXED.replace("contact.0", "contact.1")),
         force=("bodies.0.material.E=5.5", "bodies.0.material.nu=0.499", "bodies.2.rigid.motion.0.uy=-0.706"),
         peak=("bodies.0.material.E=5.5", )),
    "ring_in_ring":
    Case("runs/ring_in_ring.yaml", (), mean_pressure=("bodies.1.material.E=200000", )),
    "cup_flattening":
    Case("runs/cup_flattening.yaml", ("mesh.parameters={n_arc: 30, n_wall: 1}", ),
         plane_force=("loads.0.pressure=200", ), apex_thickness=("bodies.0.material.E=50000", )),
    "plate_cylinder":
    Case("runs/plate_cylinder.yaml",
         ("mesh.parameters={h_contact: 1, h_far: 8, n_thick: 1, n_width: 1}", FIXED,
          "contact.0.formulation=surface_to_surface"),
         tip_uy=("contact.0.master.cylinder.radius=20", "bodies.0.material.E=200000"),
         cylinder_fy=("loads.0.pressure=200", )),
    # The answer depends on the way: all runs take the same steps
    "wedge_brake":
    Case("tests/jobs/wedge_brake.yaml", (STEPS, ), brake=("contact.0.friction.mu=0.2", "loads.0.traction.0=10")),
    "brake_band":
    Case("tests/jobs/brake_band.yaml", (STEPS, ), torque=("contact.0.friction.mu=0.3", )),
    "autofrettage":
    Case("tests/jobs/autofrettage.yaml", (STEPS, ), grown=("bodies.0.material.yield=300", "bodies.0.material.E=200000")),
}


def solve(args, name, edits, *options):
    """Directory of a run, or None where it failed."""
    out = args.out / name
    shutil.rmtree(out, ignore_errors=True)
    line = command(args.burnish, 1, ROOT / CASES[name].scene, out, (*CASES[name].edits, *TIGHT, *edits),
                   "-quiet", "-overwrite", *options)
    done = subprocess.run(line, env=environment(args.burnish), capture_output=True, text=True, check=False)
    if done.returncode:
        print(name, edits, done.stderr[-400:])
    return out if done.returncode == 0 else None


def difference(args, name, probe, key, number, part):
    """Central difference of a probe between two whole runs."""
    values = []
    for sign in (1, -1):
        changed = [f"{key}={number * (1 + sign * part)!r}"]
        out = solve(args, name, changed, "-sensitivity", f"{probe}:{key}")
        if not out:
            return float("nan")
        with open(out / "sensitivity.csv", newline="") as file:
            values.append(float(next(csv.DictReader(file))["value"]))
    return (values[0] - values[1]) / (2 * part * number)


def records(args, name):
    """Those of all probes and numbers of a scene."""
    wanted = [(probe, *key.split("=")) for probe, keys in CASES[name].wanted.items() for key in keys]
    given = [f"{key}={number}" for _, key, number in wanted]
    options = [word for probe, key, _ in wanted for word in ("-sensitivity", f"{probe}:{key}")]
    out, rows = solve(args, name, given, *options), []
    if not out:
        return rows
    cpu_s = read_summary(out)["cpu_s"]
    with open(out / "sensitivity.csv", newline="") as file:
        found = list(csv.DictReader(file))
    for row in found:
        whole, half = (difference(args, name, row["probe"], row["key"], float(row["number"]), part)
                       for part in (STEP, STEP / 2))
        best = (4 * half - whole) / 3
        rows.append({
            "scene": name, "probe": row["probe"], "key": row["key"], "way": row["way"], "value": row["value"],
            "derivative": row["derivative"], "difference": f"{best:.9g}",
            "deviation": f"{float(row['derivative']) / best - 1:.2e}", "cpu_s": row["cpu_s"],
            "solve_cpu_s": f"{cpu_s - sum({r['key']: float(r['cpu_s']) for r in found}.values()):.3f}"
        })
        print(rows[-1], flush=True)
    return rows


def table(rows):
    print("| scene | probe | number | way | derivative | of whole runs | deviation | CPU over that of the run |")
    print("| --- " * 8 + "|")
    for row in rows:
        print(f"| {row['scene']} | {row['probe']} | `{row['key']}` | {row['way']} | {float(row['derivative']):.6g} "
              f"| {float(row['difference']):.6g} | {float(row['deviation']):+.1e} "
              f"| {float(row['cpu_s']) / float(row['solve_cpu_s']):.2f} |")
    good = sum(abs(float(row["deviation"])) <= 1e-4 for row in rows)
    print(f"\n{good} of {len(rows)} within 1e-4")


if __name__ == "__main__":
    fill_scenes(__doc__, "sensitivity", COLUMNS, records, CASES, table)

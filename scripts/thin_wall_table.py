"""Thin walls by elements: plain first order, enhanced strains, second order on the same node spacing; and Cook's
membrane, nearly incompressible, with fbar. Runs the scenes one after the other on one rank, leaves one record per run
and prints the tables; --table prints an existing record.
    python scripts/thin_wall_table.py [--burnish BINARY] [--out DIR] [--record FILE] [SCENE ...]
Error: per cent off the reference; CPU seconds are for one rank, meshing apart."""
import argparse
import csv
import json
import pathlib
import subprocess

from launch import ROOT, environment

COLUMNS = ("scene", "element", "mesh", "dt", "smoother", "slave", "dofs", "status", "steps", "steps_failed",
           "newton_iterations", "cpu_s", "value", "error")
ORDER_1 = {"first order": "full", "enhanced": "enhanced"}
SWAPPED = ("contact.0.slave=pipe_outer", "contact.0.master=plate_bottom")


def cantilever(probes):
    return (probes["low_y"] + probes["high_y"]) / 2


# What is compared (a function of the probes), its reference, node spacings (elements of first order along the wall, the
# edge), elements. References: the elastica (Mattiasson 1981); second order with 256 x 2 elements in the ring (enhanced
# with 256 x 4 agrees to 0.02 %); second order with 64 x 64 elements of Cook's membrane; another code on several meshes
# for the pipe (0.1 %).
SCENES = {
    "cantilever": (cantilever, 66.996, (8, 16, 32, 64), ORDER_1, "nx"),
    "ring_pinch": (lambda probes: probes["force"], 3.185, (8, 16, 32, 64), ORDER_1, "n_arc"),
    "cook": (lambda probes: probes["tip_uy"], 6.8931, (4, 8, 16, 32), {"first order": "full", "fbar": "fbar"}, "n"),
}
# elements around, through and along the wall; load step
PIPES = [("enhanced", "36x1x6", 0.05), ("enhanced", "36x1x6", 0.25), ("enhanced", "24x1x10", 0.05),
         ("second order", "12x1x10", 0.05)]
PIPE_FORCE = 123920


def run(args, scene, overrides):
    directory = args.out / scene
    command = [str(args.burnish), str(ROOT / "runs" / f"{scene}.yaml"), "-o", str(directory), "-overwrite", "-quiet"]
    for override in overrides:
        command += ["-set", override]
    finished = subprocess.run(command, env=environment(args.burnish), capture_output=True, text=True)
    if finished.returncode not in (0, 2):
        raise SystemExit(f"{' '.join(command)}\n{finished.stderr}")
    return json.loads((directory / "summary.json").read_text())


def record(summary, value, reference, **what):
    row = {
        **what,
        **{
            name: summary[name]
            for name in COLUMNS if name in summary
        }, "value": value,
        "error": 100 * (value / reference - 1)
    }
    print(", ".join(f"{key} {item}" for key, item in row.items()), flush=True)
    return row


def walls(args, scene):
    compare, reference, spacings, formulations, edge = SCENES[scene]
    for spacing in spacings:
        for name, formulation in [*formulations.items(), ("second order", "full")]:
            order = 2 if name == "second order" else 1
            summary = run(args, scene, [
                f"mesh.order={order}", f"bodies.0.formulation={formulation}",
                f"mesh.parameters.{edge}={spacing // order}"
            ])
            yield record(summary, compare(summary["probes"]), reference, scene=scene, element=name, mesh=spacing)


def pipes(args):
    for element, mesh, dt in PIPES:
        for smoother in ("facet", "diffuse"):
            for slave, roles in (("plate", ()), ("pipe", SWAPPED)):
                around, wall, along = mesh.split("x")
                formulation = "enhanced" if element == "enhanced" else "full"
                overrides = [
                    f"mesh.order={2 if element == 'second order' else 1}",
                    f"mesh.parameters={{n_arc: {around}, n_wall: {wall}, n_len: {along}}}",
                    f"bodies.0.formulation={formulation}", f"bodies.1.formulation={formulation}",
                    f"contact.0.smoother={smoother}", f"stepping.initial={dt}", *roles
                ]
                summary = run(args, "pipe_pinch", overrides)
                yield record(summary, summary["probes"]["plate_force"], PIPE_FORCE, scene="pipe_pinch", element=element,
                             mesh=mesh, dt=dt, smoother=smoother, slave=slave)


def table(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    for scene in dict.fromkeys(row["scene"] for row in rows):
        print(
            f"\n{scene}\n{'element':<13}{'mesh':>8}{'dt':>6} {'smoother':<8} {'slave':<6}{'dofs':>7}{'status':>8}"
            f"{'steps':>6}{'failed':>7}{'iterations':>11}{'CPU s':>8}{'value':>13}{'error %':>9}")
        for row in (row for row in rows if row["scene"] == scene):
            print(
                f"{row['element']:<13}{row['mesh']:>8}{row['dt']:>6} {row['smoother']:<8} "
                f"{row['slave']:<6}{row['dofs']:>7}{row['status']:>8}{row['steps']:>6}{row['steps_failed']:>7}"
                f"{row['newton_iterations']:>11}{float(row['cpu_s']):8.2f}{float(row['value']):13.4f}"
                f"{float(row['error']):9.2f}")


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("scene", nargs="*", help="cantilever, ring_pinch, cook, pipe_pinch; default: all")
parser.add_argument("--burnish", type=pathlib.Path, default=pathlib.Path("build/burnish"))
parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/thin_walls"))
parser.add_argument("--record", type=pathlib.Path, default=pathlib.Path("out/thin_walls.csv"))
parser.add_argument("--table", type=pathlib.Path, help="record to print, nothing is run")
args = parser.parse_args()
if not args.table:
    args.record.parent.mkdir(parents=True, exist_ok=True)
    with open(args.record, "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, restval="")
        writer.writeheader()
        for scene in args.scene or [*SCENES, "pipe_pinch"]:
            for row in pipes(args) if scene == "pipe_pinch" else walls(args, scene):
                writer.writerow(row)
                file.flush()
table(args.table or args.record)

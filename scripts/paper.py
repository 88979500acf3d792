"""The three examples of the paper (section 5): runs their scenes, leaves tables (CSV, and all of them in paper.md
beside the paper's own statements) and pictures that correspond to its figures 1 to 5 in out/paper/. A run that is there
already with the same input is not repeated.
    paper.py [pipe_pinch] [plate_cylinder] [cup_flattening] [-j RANKS] [--quick] [--again] [--record DIR]"""
import argparse
import csv
import hashlib
import json
import pathlib
import re
import shutil
import subprocess
import sys
import time

import numpy

import paperpictures
from launch import command, environment, read_steps, read_summary
from burnish.meshview import read_mesh, read_slave, read_states

ROOT = pathlib.Path(__file__).resolve().parent.parent
NAMES = ("pipe_pinch", "plate_cylinder", "cup_flattening")
TIME_LIMIT = 1800  # seconds for one run; the longest takes a tenth of it on two ranks

STATEMENTS = {
    "pipe_pinch":
    """Figure 1 and section 5.1: a pipe pinched between two plates, both deformable. "We observe that the number
of iterations can be reduced when the surface smoothing procedure is used. [...] The CPU time is not increased."
No figures are given.""",
    "plate_cylinder":
    """Figures 2 and 3 and section 5.2: a plate under pressure on a rigid cylinder. "With a traditional contact
algorithm, the computations have not been performed. The required precision was not reached for P = 120 MPa. [...] the
penalty parameter strongly decreases [...] In this case [with the adjustment], the penalty parameter is increased to
obtain the penetration between g_min and g_max" = 1e-6 and 5e-6 mm.""",
    "cup_flattening":
    """Figures 4 and 5 and section 5.3: a spherical cup flattened on a rigid plane. "Our initial choice has led
to 40 steps. It can be reduced to 9 steps by using our approach. Figure 5 [...] emphasizes a non-linear evolution of
load step." Iterations are not given.""",
}

SMOOTHERS = {
    "facet": ["contact.0.smoother=facet"],
    "diffuse 2 (the paper's)": ["contact.0.smoother=diffuse", "contact.0.degree=2"],
    "diffuse 4": ["contact.0.smoother=diffuse", "contact.0.degree=4"],
}
PAPERS, OURS = "diffuse 2 (the paper's)", "diffuse 4"
PREDICTIONS = ("converged", "tangent")


class Study:
    """Where runs go and how they are made; collects the tables."""

    def __init__(self, args):
        self.args, self.text = args, ["# The paper's results\n"]

    def run(self, name, scene, overrides, *options):
        """A finished run's directory; made anew only when its input has changed."""
        directory = self.args.out / "runs" / name
        source = ROOT / "runs" / f"{scene}.yaml"
        geometry = b"".join(path.read_bytes()
                            for path in sorted((ROOT / "meshes").glob(f"{scene.removesuffix('_meshed')}.geo")))
        stamp = {
            "scene": hashlib.sha256(source.read_bytes() + geometry).hexdigest(),
            "overrides": [*overrides, *options],
            "ranks": self.args.ranks
        }
        mark = directory / "paper.json"
        if not self.args.again and mark.exists() and json.loads(mark.read_text())["input"] == stamp:
            return directory
        shutil.rmtree(directory, ignore_errors=True)
        directory.parent.mkdir(parents=True, exist_ok=True)
        line = command(self.args.burnish, self.args.ranks, source, directory, overrides, "-quiet", *options)
        print(f"{name}: {' '.join(line)}", flush=True)
        start = time.monotonic()
        try:
            finished = subprocess.run(line, env=environment(self.args.burnish), stdout=subprocess.PIPE,
                                      stderr=subprocess.STDOUT, text=True, timeout=TIME_LIMIT)
        except subprocess.TimeoutExpired:
            sys.exit(f"{' '.join(line)}\nnot done after {TIME_LIMIT} s")
        if finished.returncode not in (0, 2):  # 2: did not converge, which is a result here
            sys.exit(f"{' '.join(line)}\n{finished.stdout}\nexit status {finished.returncode}")
        mark.write_text(
            json.dumps({
                "input": stamp,
                "status": finished.returncode,
                "seconds": round(time.monotonic() - start, 1)
            }))
        return directory

    def heading(self, name):
        self.text += [f"## {name}\n", STATEMENTS[name] + "\n"]

    def table(self, name, title, header, rows, note="", shown=True):
        """One table as CSV, and in paper.md unless it is a long one that a picture shows."""
        rows = [[f"{cell:.6g}" if isinstance(cell, float) else "" if cell is None else str(cell)
                 for cell in row]
                for row in rows]
        for folder in filter(None, (self.args.out, self.args.record)):
            folder.mkdir(parents=True, exist_ok=True)
            with open(folder / f"{name}.csv", "w", newline="") as file:
                csv.writer(file).writerows([header, *rows])
        lines = [f"| {' | '.join(row)} |" for row in (header, ["---"] * len(header),
                                                      *rows)] if shown else [f"{len(rows)} rows."]
        self.text.append(f"### {title} ({name}.csv)\n\n" + "\n".join(lines) + ("\n\n" + note if note else "") + "\n")

    def picture(self, name, draw, *arguments, recorded=False):
        """A picture; recorded: doc/pages/paper.md shows it."""
        figure = draw(*arguments)
        figure.savefig(self.args.out / f"{name}.png", dpi=150, bbox_inches="tight")
        if recorded and self.args.record:
            figure.savefig(self.args.record / f"{name}.png", dpi=80, bbox_inches="tight")
        self.text.append(f"![{name}]({name}.png)\n")


def stepping(**values):
    return "stepping={" + ", ".join(f"{key}: {value}" for key, value in values.items()) + "}"


def penalty(**values):
    return "contact.0.penalty={" + ", ".join(f"{key}: {value}" for key, value in {
        "initial": "auto",
        **values
    }.items()) + "}"


def outcome(directory):
    """What a run took and how it ended, for a table; status: done, or the load parameter at which it stopped."""
    summary = read_summary(directory)
    return {
        "status": "done" if summary["status"] == "done" else f"stopped at t = {summary['t']:.3g}",
        "steps": summary["steps"],
        "failed": summary["steps_failed"],
        "repeated": summary["steps_repeated"],
        "iterations": summary["newton_iterations"],
        "cpu_s": round(summary["cpu_s"], 1),
        "max_penetration": summary["max_penetration"],
        "fall_backs": summary["contact"][0]["fall_backs"],
        **summary["probes"]
    }


OUTCOME = ("status", "steps", "failed", "repeated", "iterations", "cpu_s")


def short(label):
    """A label as part of a folder's name."""
    return re.sub(r" \(.*?\)|,", "", label).replace(" ", "_")


def procedures(study, scene, common, window, traditional, control):
    """Each of the paper's procedures alone and all together: (label, directory) of its runs. window: the penalty's
    scale and bounds."""
    fixed, adjusted = penalty(**window), penalty(**window, adjust="true")
    cases = [("traditional", "facet", fixed, traditional)]
    cases += [(f"{smoother} alone", smoother, fixed, traditional) for smoother in (PAPERS, OURS)]
    cases += [("adjusted penalty alone", "facet", adjusted, traditional),
              ("controlled steps alone", "facet", fixed, control)]
    cases += [(f"all together, {smoother}", smoother, adjusted, control) for smoother in (PAPERS, OURS)]
    return [(label, study.run(f"{scene}-{short(label)}", scene, [*common, *SMOOTHERS[smoother], penalties, steps]))
            for label, smoother, penalties, steps in cases]


def row_of(label, directory, keys):
    result = outcome(directory)
    return [label, *(result[key] for key in keys)]


def reference_row(keys, reference):
    return ["reference, another code", *(reference.get(key, "") for key in keys)]


# pipe_pinch: surface smoothing, and the rules on its mesh

PIPE_REFERENCE = {"plate_force": 123920, "diameter_h_mid": 61.05, "crown_gap": 0.0125}
PIPE_STEPS = (0.01, 0.02, 0.04, 0.1, 0.25, 1)


def pipe_pinch(study):
    scene = "pipe_pinch"
    study.heading(scene)
    quick = ["mesh.parameters={n_arc: 12, n_wall: 1, n_len: 5}"] if study.args.quick else []
    fixed, control = {
        "control": "fixed",
        "initial": 0.05
    }, {
        "control": "contact",
        "initial": 0.05,
        "N_c_fraction": 0.05
    }

    window = {"scale": 100, "g_min": 2e-4, "g_max": 1e-3, "unit": "length"}
    runs = procedures(study, scene, quick, window, stepping(**fixed, at="[0.5]"),
                      stepping(**control, prediction="tangent", at="[0.5]"))
    keys = [*OUTCOME, "max_penetration", "fall_backs", *PIPE_REFERENCE]
    rows = [*(row_of(label, directory, keys) for label, directory in runs), reference_row(keys, PIPE_REFERENCE)]
    study.table(
        "pipe_pinch_procedures", "The procedures alone and together", ["procedure", *keys], rows,
        "Master: the pipe's meshed surface. Fixed steps: 20 of t = 0.05; controlled: a twentieth of the slave area "
        "comes into contact per step, tangent prediction."
    )

    common = [*quick, *SMOOTHERS[OURS], penalty(scale=100), "stepping.at=[]", "output.every=0"]
    taken = {
        f"uniform, {dt:g}": study.run(f"{scene}-uniform-{dt:g}", scene,
                                      [*common, stepping(control="fixed", initial=dt)])
        for dt in PIPE_STEPS
    }
    for prediction in PREDICTIONS:
        taken[f"control from 0.05, {prediction}"] = study.run(
            f"{scene}-control-{prediction}", scene, [*common, stepping(**control, prediction=prediction)])
    exact = outcome(taken[f"uniform, {PIPE_STEPS[0]:g}"])["plate_force"]
    rows = []
    for label, directory in taken.items():
        row = row_of(label, directory, [*OUTCOME, "plate_force"])
        rows.append([*row, 100 * (row[-1] / exact - 1) if row[1] == "done" else None])
    study.table("pipe_pinch_steps", "Controlled steps against uniform ones, diffuse 4",
                ["steps of t", *OUTCOME, "plate_force", "error of it in %, to the smallest steps"], rows)

    mesh, states = read_mesh(runs[2][1] / "results.h5"), read_states(runs[2][1] / "results.h5", "displacement",
                                                                     "von_mises")
    study.picture("fig1a", paperpictures.pipe, mesh, None)
    study.picture("fig1b", paperpictures.pipe, mesh, states[-1])


# plate_cylinder: the penalty

WINDOW = (1e-6, 5e-6)  # mm, the paper's
LIGHT = 1e-3  # of the largest nodal force: nodes below it are not held to the lower bound
SCALES = (1e-4, 1, 1e4)  # of the automatic penalty
PLATE_REFERENCE = {
    "tip_uy": -0.845,
    "cylinder_fx": 1326,
    "cylinder_fy": 79234,
    "contact_x_min": 49.59,
    "contact_x_max": 51.06,
    "peak_pressure": 3590
}
BOUNDS = {"g_min": WINDOW[0], "g_max": WINDOW[1], "unit": "length"}
LAWS = {
    "fixed": {},
    "adjusted, converged": {
        "adjust": "true",
        "when": "converged"
    },
    "adjusted, step (eq. 16)": {
        "adjust": "true",
        "when": "step"
    }
}
PLATE_STEPS = stepping(control="fixed", initial=0.1)  # 20 MPa
PRESSURE = 200  # MPa at t = 1, here and of the cup


SHARE = {1: (1, 1), 2: (1, 4, 1)}  # of an element's length that its nodes get, by the order of the elements


def tributary(x, order):
    """Reference areas of the nodes of a grid of rectangles, x: n x 2."""
    area, share = numpy.ones(len(x)), numpy.array(SHARE[order]) / sum(SHARE[order])
    for axis in range(2):
        grid, place = numpy.unique(numpy.round(x[:, axis], 9), return_inverse=True)
        weight = numpy.zeros(len(grid))
        for first in range(0, len(grid) - order, order):
            weight[first:first + order + 1] += (grid[first + order] - grid[first]) * share
        area *= weight[place]
    return area


HISTORY = ("P", "x", "z", "penalty", "penetration", "largest_penetration", "in_contact", "inside", "excess")


def history(directory, order):
    """Per written step: P; place, penalty and penetration of the node that carries the largest force; over all nodes in
    contact: the largest penetration, how many they are, how many of them are inside the window, and the largest factor
    by which one is outside."""
    path = directory / "results.h5"
    if not path.exists():
        return []
    x = read_mesh(path)[0][read_slave(path, "ridge")]
    area, rows = tributary(x[:, [0, 2]], order), []
    for t, eps, penetration in read_states(path, "contact/ridge/penalty", "contact/ridge/penetration"):
        force, closed = eps * area * penetration, penetration > 0
        top = numpy.argmax(force)
        below = numpy.where(force[closed] < LIGHT * force[top], 0, WINDOW[0] / penetration[closed])
        excess = numpy.maximum(below, penetration[closed] / WINDOW[1])
        rows.append(
            dict(
                zip(HISTORY, (PRESSURE * t, float(x[top, 0]), float(x[top, 2]), float(eps[top]), float(
                    penetration[top]), float(penetration.max()), int(closed.sum()), int(
                        (excess <= 1).sum()), float(excess.max())))))
    return rows


def classical(study, scene, common, *options):
    """The classical approach of the paper's figure 3(a), emulated: the penalty starts stiff enough for the window and
    is divided by ten whenever a step fails. The problem does not depend on its path, so that each penalty is run from
    the start, without smaller steps. Returns the accepted steps, each with its factor on the automatic penalty (scale)
    and those that failed at it (tried), and the outcome, iterations of all runs together."""
    accepted, tried, total, iterations, scale = [], [], 0, 0, max(SCALES)
    while True:
        name = f"{scene}-classical{'-plain' if options else ''}-{scale:g}"
        directory = study.run(
            name, scene, [*common, penalty(scale=scale),
                          stepping(control="fixed", initial=0.1, dt_min=0.1)], *options)
        for row in history(directory, 1)[len(accepted):]:
            accepted.append({**row, "scale": scale, "tried": tried})
            tried = []
        result = outcome(directory)
        iterations += result["iterations"]
        if result["status"] == "done" or scale <= min(SCALES):
            return accepted, {**result, "iterations": iterations, "failed": total}
        tried, total, scale = [*tried, scale], total + 1, scale / 10


def plate_surface(study, scene, plate, plane):
    """The surface: the same plate of first-order elements, penalty and steps on the exact cylinder and on plane
    facets."""
    common = [penalty(scale=100), PLATE_STEPS]
    runs = {"exact cylinder": study.run(f"{scene}-exact", scene, [*plate, *common])}
    for turn, mesh in plane.items():
        for smoother, choice in SMOOTHERS.items():
            label = f"{smoother}, {'a vertex' if turn == 0 else 'the middle of a facet'} at x = 50"
            runs[label] = study.run(f"{scene}_meshed-{short(smoother)}-turn_{turn}", f"{scene}_meshed",
                                    [*mesh, *choice, *common])
    exact, rows = outcome(runs["exact cylinder"]), []
    for label, directory in runs.items():
        result = outcome(directory)
        differences = result["tip_uy"] - exact["tip_uy"], 100 * (result["peak_pressure"] / exact["peak_pressure"] - 1)
        rows.append([*row_of(label, directory, [*OUTCOME, *PLATE_REFERENCE]), *differences])
    study.table("plate_cylinder_surface",
                "The surface: facets of one degree against the exact cylinder, first-order elements",
                ["master", *OUTCOME, *PLATE_REFERENCE, "tip to exact, mm", "peak pressure to exact, %"], rows,
                "The same plate mesh, penalty and steps in every row: differences are the surface's.")


def plate_scenes(study, scene, quick):
    """Second-order elements, a fixed penalty; returns the run on the exact cylinder."""
    meshed = [mesh.replace("}", ", cylinder: 1}") for mesh in quick]
    runs = {"exact cylinder": study.run(f"{scene}-order_2-exact", scene, [*quick, penalty(scale=100), PLATE_STEPS])}
    for smoother, choice in SMOOTHERS.items():
        runs[smoother] = study.run(f"{scene}_meshed-order_2-{short(smoother)}", f"{scene}_meshed",
                                   [*meshed, *choice, penalty(scale=100), PLATE_STEPS])
    keys = [*OUTCOME, *PLATE_REFERENCE]
    study.table(
        "plate_cylinder_order_2", "The mesh of the scenes, second-order elements: facets are curved", ["master", *keys],
        [*(row_of(label, directory, keys) for label, directory in runs.items()),
         reference_row(keys, PLATE_REFERENCE)])
    return runs["exact cylinder"]


def plate_penalties(study, scene, quick, plane):
    """The penalty: the exact cylinder, second-order elements; the classical approach on facets."""
    cases, rows = {}, []
    for law, keys in LAWS.items():
        for scale in SCALES:
            directory = study.run(f"{scene}-{short(law)}-scale_{scale:g}", scene,
                                  [*quick, penalty(scale=scale, **BOUNDS, **keys), PLATE_STEPS])
            cases[law, scale] = history(directory, 2)
            rows.append(summarise_penalty(law, scale, outcome(directory), cases[law, scale]))
    for law, options in (("emulated classical, plain Newton", ("-snes_linesearch_type", "basic", "-ksp_type", "gmres")),
                         ("emulated classical, with line search", ())):
        cases[law, SCALES[-1]], result = classical(study, f"{scene}_meshed", plane, *options)
        rows.append(summarise_penalty(law, SCALES[-1], result, cases[law, SCALES[-1]]))
    header = [
        "penalty", "start, times automatic", *OUTCOME[:-1], "inside the window at the end, %",
        "smallest share of a step, %", "largest excess of a step", "largest excess at the end",
        "largest penetration at the end", "tip_uy", "peak_pressure"
    ]
    study.table(
        "plate_cylinder_penalty", "Fixed and adjusted penalty", header, rows,
        f"Window {WINDOW[0]:g} to {WINDOW[1]:g} mm. Shares count nodes in contact; excess is the factor by which the "
        f"worst node is outside; nodes with less than {LIGHT:g} of the "
        "largest nodal force are not held to the lower bound. Emulated: facets, first-order elements, ten times softer "
        "whenever a step fails."
    )
    rows = [[law, scale, *(row[key]
                           for key in HISTORY), " ".join(f"{factor:g}"
                                                         for factor in row.get("tried", ()))]
            for (law, scale), taken in cases.items()
            for row in taken]
    study.table("plate_cylinder_history", "Per step: the node that carries the largest force (figure 3)",
                ["penalty", "start, times automatic", *HISTORY, "failed with (times automatic)"], rows, shown=False)
    pictures = {False: {}, True: {}}
    for (law, scale), taken in cases.items():
        pictures[law.startswith("adjusted")][f"{law}, {scale:g}"] = taken
    study.picture("fig3a", paperpictures.penalties, pictures[False], WINDOW,
                  "(a) fixed, and classical emulated: eps/10 at each failed step", recorded=True)
    study.picture("fig3b", paperpictures.penalties, pictures[True], WINDOW, "(b) automatic adjustment", recorded=True)


def plate_cylinder(study):
    scene, quick = "plate_cylinder", ["mesh.parameters={h_contact: 0.5, h_far: 5, n_thick: 2, n_width: 3}"
                                      ] if study.args.quick else []
    study.heading(scene)
    size = "h_contact: 0.25, h_far: 3, n_thick: 4, n_width: 6"
    if study.args.quick:
        size = "h_contact: 0.5, h_far: 5, n_thick: 2, n_width: 4"
    plane = {turn: ["mesh.order=1", f"mesh.parameters={{{size}, cylinder: 1, turn: {turn}}}"] for turn in (0, 0.5)}
    plate_surface(study, scene, ["mesh.order=1", f"mesh.parameters={{{size}}}"], plane)

    runs = procedures(study, f"{scene}_meshed", plane[0], {
        "scale": 100,
        **BOUNDS
    }, PLATE_STEPS, stepping(control="contact", initial=0.1, N_c=5, prediction="tangent"))
    keys = [*OUTCOME, "max_penetration", "fall_backs", *PLATE_REFERENCE]
    study.table(
        "plate_cylinder_procedures", "The procedures alone and together, meshed cylinder", ["procedure", *keys],
        [row_of(label, directory, keys) for label, directory in runs],
        "First-order elements, plane facets of one degree, a vertex at x = 50. Controlled: N_c = 5, tangent prediction."
    )

    exact = plate_scenes(study, scene, quick) / "results.h5"
    study.picture("fig2a", paperpictures.plate_geometry)
    study.picture("fig2b", paperpictures.plate, read_mesh(exact), read_states(exact, "displacement", "von_mises")[-1])
    plate_penalties(study, scene, quick, plane[0])


def summarise_penalty(law, scale, result, rows):
    """A row of the table of penalties."""
    shares, last = [100 * row["inside"] / row["in_contact"] for row in rows], rows[-1] if rows else None
    return [
        law,
        float(scale), *(result[key] for key in OUTCOME[:-1]), shares[-1] if rows else None,
        min(shares, default=None),
        max((row["excess"] for row in rows), default=None), last and last["excess"], last
        and last["largest_penetration"], result["tip_uy"], result["peak_pressure"]
    ]


# cup_flattening: the load step

CUP_REFERENCE = {"plane_force": 434500, "contact_radius": 25.10, "apex_thickness": 1.9246}
ELEMENTS = {1: 120, 2: 60}  # along the arc, by order: the same number of nodes


def cup_flattening(study):
    scene = "cup_flattening"
    study.heading(scene)
    choices = {"uniform": stepping(control="fixed", initial=0.025), "single step": stepping(control="fixed", initial=1)}
    choices |= {
        f"control, {prediction}": stepping(control="contact", initial=0.025, N_c=5, prediction=prediction)
        for prediction in PREDICTIONS
    }
    keys, counts = [*OUTCOME, *CUP_REFERENCE], ("newton", "attempts", "contact_nodes", "nodes_in", "nodes_out")
    rows, steps = [], []
    for order, n_arc in ELEMENTS.items():
        mesh = [
            f"mesh.order={order}", f"mesh.parameters={{n_arc: {n_arc // 2 if study.args.quick else n_arc}, n_wall: 2}}"
        ]
        for label, choice in choices.items():
            directory = study.run(f"{scene}-order_{order}-{short(label)}", scene, [*mesh, penalty(scale=100), choice])
            rows.append([order, *row_of(label, directory, keys)])
            taken = read_steps(directory)
            for k in range(len(taken["t"])):
                steps.append([
                    order, label, PRESSURE * taken["t"][k], PRESSURE * taken["dt"][k],
                    *(int(taken[name][k]) for name in counts)
                ])
    study.table(
        "cup_flattening", "Load steps", ["order", "steps of the load", *keys],
        [*rows, ["", *reference_row(keys, CUP_REFERENCE)]],
        "N_c = 5 slave nodes, first step 5 MPa. The plane is analytic: there is no surface to smooth, and facet and "
        "diffuse are the same run. Iterations are all Newton iterations "
        "of the run, those of failed and repeated attempts and of predictions included.")
    study.table("cup_flattening_steps", "Per step (figure 5)",
                ["order", "steps of the load", "P", "dP", "iterations", *counts[1:]], steps, shown=False)

    path = study.args.out / "runs" / f"{scene}-order_2-uniform" / "results.h5"
    mesh = read_mesh(path)
    study.picture("fig4a", paperpictures.cup, mesh, None)
    study.picture("fig4b", paperpictures.cup, mesh, read_states(path, "displacement", "von_mises")[-1])
    study.picture("fig5", paperpictures.load_steps, steps, recorded=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("examples", nargs="*", choices=[[], *NAMES], help="which; default: all")
    parser.add_argument("-j", "--ranks", type=int, default=2)
    parser.add_argument("--burnish", type=pathlib.Path, default=ROOT / "build/burnish")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out/paper")
    parser.add_argument(
        "--record", type=pathlib.Path,
        help="a second place for the tables and the pictures of doc/pages/paper.md (runs/records/paper)")
    parser.add_argument("--quick", action="store_true",
                        help="coarse meshes: shows that everything runs, its figures mean nothing")
    parser.add_argument("--again", action="store_true", help="repeats runs that are there")
    args = parser.parse_args()
    study = Study(args)
    for name in args.examples or NAMES:
        {"pipe_pinch": pipe_pinch, "plate_cylinder": plate_cylinder, "cup_flattening": cup_flattening}[name](study)
    (args.out / "paper.md").write_text("\n".join(study.text))
    print(f"{args.out / 'paper.md'}, with the tables as CSV and the pictures beside it")


main()

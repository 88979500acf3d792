"""What an accuracy of 0.2 % costs on free meshes: by meshes of the run's own choice (-to 0.2), by uniform refinement of
the same first mesh, which is divided by 1, 2, 4 and so on, and by the best single mesh of a study by hand, graded towards
the contact or the corner. Leaves one record per mesh, prints the table and draws the errors over unknowns and over CPU
seconds, with meshes of the loop down to 0.01 %, which show the rate; --print tables and draws an existing record, --only
runs some scenes.
    python scripts/adaptive_table.py [--burnish BINARY] [--record FILE] [--only NAME ...]
CPU seconds of the loop are those of all meshes, those of uniform refinement and of the study by hand of the first mesh
alone that has the accuracy; gmsh's are apart. All runs have the penalties of the same wish. References are those of
wish_table.py, and for the bracket the answer of the loop at 0.01 %."""
import csv
import shutil
import subprocess

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import NullFormatter

from launch import ROOT, command, environment, fill_scenes, read_records

WISH, FINE, MOST_CPU = 0.2, 0.01, 15  # per cent; of the meshes that show the rate; seconds of one mesh
COLUMNS = ("scene", "way", "mesh", "unknowns", "cpu_s", "gmsh_s", "value", "estimate", "reference")
BRACKET = tuple({"refine": refine, "near": near} for refine in (0.5, 1, 2) for near in (2, 4, 8, 16))
NEAR = tuple({"refine": refine, "near": near} for refine in (0.3, 0.5, 1, 2) for near in (8, 16, 32))
LABELS = {"loop": "-to 0.2", "fine": "-to 0.01", "uniform": "uniform"}
CASES = {  # scene, probe, parameters of the first mesh, meshes of the study by hand, reference
    "bracket": ("runs/free/bracket.yaml", "force", {}, BRACKET, 0.227703),
    "hertz_line": ("runs/free/hertz_line.yaml", "force", {}, NEAR, 2702.82),
    "hertz_line patch": ("runs/free/hertz_line.yaml", "patch", {}, NEAR, 1365.39),
    "hertz_sphere": ("runs/free/hertz_sphere.yaml", "force", {}, NEAR, 17318.5),
    "hertz_sphere patch": ("runs/free/hertz_sphere.yaml", "patch", {}, NEAR, 1546.8),
    "ring_in_ring": ("runs/free/ring_in_ring.yaml", "mean_pressure", {}, tuple({"refine": r} for r in (1, 2, 3, 4, 6)),
                     6.43887),
    "lip_seal": ("tests/jobs/lip_seal.yaml", "lip_up", {"refine": 0.5}, tuple({"refine": r}
                                                                             for r in (0.5, 1, 1.5, 2, 3)), 0.46007),
}


def meshes(args, name, wish, parameters, *edits):
    """The rows of accuracy.csv of a run."""
    scene, probe, *_ = CASES[name]
    out = args.out / name.replace(" ", "_")
    shutil.rmtree(out, ignore_errors=True)
    given = [f"mesh.parameters.{key}={value}" for key, value in parameters.items()]
    line = command(args.burnish, 1, ROOT / scene, out, (*given, *edits), "-quiet", "-to", str(wish), "-probe", probe)
    finished = subprocess.run(line, env=environment(args.burnish), capture_output=True, text=True, check=False)
    if not (out / "accuracy.csv").exists():
        print(name, parameters, finished.stderr[-400:])
        return []
    with open(out / "accuracy.csv", newline="") as file:
        return list(csv.DictReader(file))


def records(args, name):
    """Those of the loop, of uniform refinement and of the study by hand."""
    *_, first, study, reference = CASES[name]
    rows = []

    def take(way, mesh, found):
        rows.append({"scene": name, "way": way, "mesh": mesh, "unknowns": found["unknowns"], "cpu_s": found["cpu_s"],
                     "gmsh_s": found["gmsh_s"], "value": found["value"], "estimate": found["per_cent"],
                     "reference": f"{reference:.9g}"})

    def error():
        return abs(100 * (float(rows[-1]["value"]) / reference - 1))

    for k, found in enumerate(meshes(args, name, WISH, first)):
        take("loop", k + 1, found)
    for k, found in enumerate(meshes(args, name, FINE, first, f"accuracy.limit.time={MOST_CPU}")):
        take("fine", k + 1, found)
    below, divide = 0, 1
    while below < 2:  # one mesh that is near by chance is no accuracy
        found = meshes(args, name, WISH, {**first, "refine": first.get("refine", 1) * divide}, "accuracy.meshes=1")
        if not found:
            break
        take("uniform", divide, found[0])
        below = below + 1 if error() <= WISH else 0
        divide *= 2
        if float(found[0]["cpu_s"]) > MOST_CPU / 3:
            break
    for parameters in study:
        found = meshes(args, name, WISH, {**first, **parameters}, "accuracy.meshes=1")
        if found and float(found[0]["cpu_s"]) <= MOST_CPU:
            take("by hand", "; ".join(f"{key} {value}" for key, value in parameters.items()), found[0])
    return rows


def error(row):
    """True error in per cent."""
    return abs(100 * (float(row["value"]) / float(row["reference"]) - 1))


def totals(rows):
    """CPU seconds up to each row."""
    sums, total = [], 0
    for row in rows:
        total += float(row["cpu_s"])
        sums.append(total)
    return sums


def cost(rows, way):
    """CPU seconds, unknowns and error at which a way has the accuracy; None: it never has."""
    mine = [row for row in rows if row["way"] == way]
    if way == "by hand":
        good = sorted((float(row["cpu_s"]), row) for row in mine if error(row) <= WISH)
        return (good[0][0], good[0][1]) if good else None
    sums = totals(mine)
    if way == "loop":
        return sums[-1], mine[-1]
    for k, row in enumerate(mine):
        if all(error(later) <= WISH for later in mine[k:]):
            return float(row["cpu_s"]), row
    return None


def table(rows):
    print("| scene | loop: meshes | unknowns | CPU (s) | true error (%) | uniform: unknowns | CPU (s) "
          "| loop over uniform | by hand: unknowns | CPU (s) | loop over by hand |")
    print("| --- " * 11 + "|")
    for name in dict.fromkeys(row["scene"] for row in rows):
        mine = [row for row in rows if row["scene"] == name]
        loop, uniform, hand = (cost(mine, way) for way in ("loop", "uniform", "by hand"))
        cells = [name, str(sum(row["way"] == "loop" for row in mine)), loop[1]["unknowns"], f"{loop[0]:.2f}",
                 f"{error(loop[1]):.3f}"]
        for other in (uniform, hand):
            cells += [other[1]["unknowns"], f"{other[0]:.2f}", f"{loop[0] / other[0]:.2f}"] if other else ["-"] * 3
        print("| " + " | ".join(cells) + " |")


def slope(panel, rows):
    """The optimal rate of second order in the plane: the error of a smooth quantity falls with the unknowns squared."""
    first = max((row for row in rows if row["way"] == "fine"), key=error, default=None)
    if first:
        start = float(first["unknowns"])
        panel.loglog([start, 10 * start], [error(first), error(first) / 100], color="#999999", lw=0.8,
                     ls="--", label="optimal rate")


def draw(rows, path):
    """Errors over unknowns above, over CPU seconds of all meshes below."""
    names = list(dict.fromkeys(row["scene"] for row in rows))
    figure, axes = plt.subplots(2, len(names), figsize=(3 * len(names), 6), squeeze=False)
    for column, name in zip(axes.T, names):
        for way, colour, marker in (("loop", "#0072b2", "o"), ("fine", "#009e73", "^"),
                                    ("uniform", "#d55e00", "s")):
            mine = [row for row in rows if row["scene"] == name and row["way"] == way]
            errors = [max(error(row), 1e-3) for row in mine]
            unknowns = [float(row["unknowns"]) for row in mine]
            column[0].loglog(unknowns, errors, marker=marker, color=colour, label=LABELS[way])
            column[1].loglog(totals(mine), errors, marker=marker, color=colour, label=LABELS[way])
        hand = [row for row in rows if row["scene"] == name and row["way"] == "by hand"]
        column[1].loglog([float(row["cpu_s"]) for row in hand], [max(error(row), 1e-3) for row in hand], ".",
                         color="#999999", label="single meshes by hand")
        slope(column[0], [row for row in rows if row["scene"] == name])
        column[0].set_title(name, fontsize=10)
        column[0].set_xlabel("unknowns")
        column[1].set_xlabel("CPU seconds, all meshes")
        for panel in column:
            panel.xaxis.set_minor_formatter(NullFormatter())
            panel.axhline(WISH, color="black", lw=0.6, ls=":")
            panel.grid(True, which="major", lw=0.3)
    axes[0][0].set_ylabel("error, %")
    axes[1][0].set_ylabel("error, %")
    axes[1][0].legend(fontsize=7)
    axes[0][0].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, dpi=72)


if __name__ == "__main__":
    fill_scenes(__doc__, "adaptive", COLUMNS, records, CASES, table, draw)

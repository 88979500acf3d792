"""Estimates of the probes' errors against the true ones: scenes of this repository on several meshes, both orders, with
output.error, against a reference of the same scene on a finer mesh, or a known one: Lame's for shrink fits, those of
wish_table.py and adaptive_table.py. Leaves one record per probe and mesh and prints the
table; --print tables an existing record, --only runs some scenes.
    python scripts/error_table.py [--burnish BINARY] [--record FILE] [--only NAME ...]
Effectivity is the true error over what the run states: the estimated one with its sign, or where parts cancel, how
large the error may be with either sign; these rows are marked as +-, and their effectivity has no sign. Rows whose true
error is below 0.05 %, or below four times that of the reference as estimated, are listed apart: they say nothing of the
estimate. The last line says, too, what the signed sums alone would be worth."""
import shutil
import subprocess

from launch import ROOT, command, environment, fill_scenes, read_summary
from wish_table import PLATE_TIP, PUNCH, PUNCH_FORCE

SMALL, TIMES = 0.05, 4  # per cent; of the reference's own error
COLUMNS = ("scene", "order", "mesh", "probe", "status", "dofs", "cpu_s", "value", "estimate", "uncertain", "bodies",
           "surfaces", "faces", "penetration", "spread", "zone", "reference", "reference_error")


class Case:
    """A scene with its meshes: parameters of each, and of the reference, with overrides of that alone."""

    def __init__(self, scene, probes, meshes, reference=None, overrides=(), orders=(1, 2), finest=("mesh.order=2", ),
                 second=(), known=None):
        self.known = known  # {probe: (value, its error)} in the place of a reference mesh
        self.scene, self.probes, self.meshes, self.reference = scene, probes, meshes, reference
        self.overrides, self.orders, self.finest, self.second = overrides, orders, finest, second

    def edits(self, order, mesh):
        return [f"mesh.order={order}", f"mesh.parameters={{{mesh}}}", *self.overrides,
                *(self.second if order == 2 else ())]


SHORT = ("bodies.0.formulation=full", )
STIFFER = ("contact.0.penalty={initial: auto, scale: 100}", )
STIFF = "contact.0.penalty={initial: auto, scale: 1000}"
CASES = {
    "cook":
    Case("runs/cook.yaml", ("tip_uy", ), ("n: 4", "n: 8", "n: 16"), "n: 48", second=("bodies.0.formulation=mixed", ),
         finest=("mesh.order=2", "bodies.0.formulation=mixed")),
    "cook enhanced":
    Case("runs/cook.yaml", ("tip_uy", ), ("n: 4", "n: 8", "n: 16"), "n: 48", orders=(1, ),
         overrides=("bodies.0.formulation=enhanced", "bodies.0.material.nu=0.3"),
         finest=("mesh.order=2", "bodies.0.formulation=mixed")),
    "cantilever":
    Case("runs/cantilever.yaml", ("high_x", "high_y"), orders=(2, ), meshes=
         ("lx: 100, ly: 1, nx: 8, ny: 1, skew: 0", "lx: 100, ly: 1, nx: 16, ny: 1, skew: 0",
          "lx: 100, ly: 1, nx: 32, ny: 1, skew: 0"), reference="lx: 100, ly: 1, nx: 256, ny: 4, skew: 0", second=SHORT,
         finest=("mesh.order=2", *SHORT)),
    "ring_pinch":
    Case("runs/ring_pinch.yaml", ("force", "width"),
         ("r_in: 99, r_out: 101, n_arc: 8, n_wall: 1", "r_in: 99, r_out: 101, n_arc: 16, n_wall: 1",
          "r_in: 99, r_out: 101, n_arc: 32, n_wall: 1"), "r_in: 99, r_out: 101, n_arc: 200, n_wall: 24", second=SHORT,
         orders=(2, ),
         finest=("mesh.order=2", *SHORT)),
    "ring_in_ring":
    Case("runs/ring_in_ring.yaml", ("mean_pressure", ), ("n_inner: 8, n_outer: 10", "n_inner: 16, n_outer: 20",
                                                         "n_inner: 32, n_outer: 40"),
         known={"mean_pressure": (6.43887, 1e-4)}),
    "spheres":
    Case("runs/spheres.yaml", ("mean_pressure", ), ("n_inner: 3, n_outer: 4", "n_inner: 5, n_outer: 6"),
         known={"mean_pressure": (15.22436, 1e-4)}),
    "hertz_line":
    Case("runs/hertz_line.yaml", ("force", ),
         ("h: 1.6, growth: 0.6", "h: 0.8, growth: 0.3", "h: 0.4, growth: 0.15"), "h: 0.2, growth: 0.06",
         overrides=("loads=[{surface: cylinder_cut, uy: -0.3}]", ), finest=("mesh.order=2", STIFF)),
    "o_ring":
    Case("runs/o_ring.yaml", ("force", ), ("n: 6", "n: 12", "n: 24"), "n: 40",
         finest=("mesh.order=2", STIFF, "contact.1.penalty={initial: auto, scale: 1000}")),
    "punch":
    Case("runs/punch.yaml", ("force", ), ("n: 2", "n: 4", "n: 8"), overrides=(PUNCH, ),
         known={"force": (PUNCH_FORCE, 1e-5)}),
    "cup_flattening":
    Case("runs/cup_flattening.yaml", ("plane_force", ), ("n_arc: 30, n_wall: 1", "n_arc: 60, n_wall: 2"),
         "n_arc: 160, n_wall: 3"),
    "bracket":
    Case("runs/free/bracket.yaml", ("force", ), ("refine: 1", "refine: 2", "refine: 4, near: 8"),
         known={"force": (0.227703, 2e-5)}),
    "free hertz_line":
    Case("runs/free/hertz_line.yaml", ("force", "patch"), ("near: 5", "near: 10", "refine: 2, near: 10"),
         overrides=STIFFER, known={"force": (2702.82, 0.1), "patch": (1365.39, 0.1)}),
    "free hertz_sphere":
    Case("runs/free/hertz_sphere.yaml", ("force", "patch"), ("near: 10", "near: 20", "refine: 2, near: 20"),
         overrides=STIFFER, known={"force": (17318.5, 0.7), "patch": (1546.8, 0.4)}),
    "plate_cylinder":
    Case("runs/plate_cylinder.yaml", ("tip_uy", ), ("h_contact: 1, h_far: 8, n_thick: 1, n_width: 1", ), orders=(2, ),
         overrides=("contact.0.penalty={initial: auto}", "contact.0.formulation=surface_to_surface"),
         known={"tip_uy": (PLATE_TIP, 2e-4)}),
    "pipe_pinch":
    Case("runs/pipe_pinch.yaml", ("plate_force", ), ("n_arc: 12, n_wall: 1, n_len: 4", "n_arc: 16, n_wall: 1, n_len: 6"),
         orders=(2, ), known={"plate_force": (123899, 60)}),
}


def part(error, cause):
    """What a cause leaves as estimated, 0 where it is not included."""
    value = error["causes"][cause]
    return f"{0 if value == 'not included' else value:.4g}"


def solve(args, name, edits):
    out = args.out / name
    shutil.rmtree(out, ignore_errors=True)
    line = command(args.burnish, 1, ROOT / CASES[name].scene, out, (*edits, "output.error=true"), "-quiet",
                   "-overwrite")
    finished = subprocess.run(line, env=environment(args.burnish), capture_output=True, text=True, check=False)
    if finished.returncode:
        print(name, edits, finished.stderr[-400:])
    return read_summary(out) if finished.returncode == 0 else None


def records(args, name):
    """Those of all probes of a scene on all meshes."""
    case, rows = CASES[name], []
    best = case.known or solve(args, name, [*case.edits(2, case.reference), *case.finest])["error"]
    for order in case.orders:
        for mesh in case.meshes:
            found = solve(args, name, case.edits(order, mesh))
            for probe in case.probes if found else ():
                error, own = found["error"].get(probe, {}), best.get(probe, {})
                if case.known:
                    own = dict(zip(("value", "magnitude", "sum"), (*own, 0)))
                if "sum" not in error or "sum" not in own:
                    print(name, probe, error, own)
                    continue
                rows.append({
                    "scene": name, "order": order, "mesh": mesh.replace(",", ";"), "probe": probe,
                    "status": found["status"],
                    "dofs": found["dofs"], "cpu_s": f"{found['cpu_s']:.2f}", "value": f"{error['value']:.9g}",
                    "estimate": f"{error['sum']:.4g}", "uncertain": f"{error['uncertain']:.4g}",
                    "bodies": part(error, "bodies"), "surfaces": part(error, "contact surfaces"),
                    "faces": part(error, "contact within faces"), "penetration": part(error, "penetration"),
                    "spread": f"{error['spread']:.4g}",
                    "zone": f"{max((z['per_cent'] for z in found.get('error_zones', {}).values()), default=0):.3g}",
                    "reference": f"{own['value']:.9g}",
                    "reference_error": f"{own['magnitude']:.3g}"
                })
    return rows


def true_error(row):
    return float(row["reference"]) - float(row["value"])


def apart(row):
    """Says whether the true error is too small to judge the estimate."""
    error, value = abs(true_error(row)), abs(float(row["reference"]))
    return error < SMALL / 100 * value or error < TIMES * float(row["reference_error"])


def cancels(row):
    """Says whether the parts of the estimate cancel, so that it has no sign."""
    return float(row["uncertain"]) > abs(float(row["estimate"]))


def signed(row):
    """The true error over the sum of the parts."""
    return true_error(row) / float(row["estimate"])


def effectivity(row):
    """The true error over what the run states."""
    return abs(true_error(row)) / float(row["uncertain"]) if cancels(row) else signed(row)


def count(ratios):
    """How many are within a factor of two; further off than a factor of four; of the wrong sign."""
    return (sum(0.5 <= ratio <= 2 for ratio in ratios),
            sum(not 0.25 <= ratio <= 4 for ratio in ratios if ratio > 0), sum(ratio <= 0 for ratio in ratios))


def besides(row):
    """What the run says that may be left besides: ends of zones of contact."""
    return float(row["zone"]) / 100 * abs(float(row["value"]))


def table(rows):
    print("| scene | order | unknowns | probe | value | true error (%) | estimate (%) | besides up to (%) "
          "| effectivity |")
    print("| --- " * 9 + "|")
    judged = [row for row in rows if not apart(row)]
    for row in judged + [row for row in rows if apart(row)]:
        value, true = float(row["reference"]), true_error(row)
        ratio = "apart" if apart(row) else f"{effectivity(row):.2f}{' +-' if cancels(row) else ''}"
        estimate = f"{100 * float(row['estimate']) / abs(value):+.3g}"
        if cancels(row):
            estimate = f"+-{100 * float(row['uncertain']) / abs(value):.3g} (sum {estimate})"
        print(f"| {row['scene']} | {row['order']} | {row['dofs']} | {row['probe']} | {float(row['value']):.5g} "
              f"| {100 * true / abs(value):+.3g} | {estimate} "
              f"| {100 * besides(row) / abs(value):.2g} | {ratio} |")
    ratios = [effectivity(row) for row in judged]
    (good, far, wrong), sums = count(ratios), count([signed(row) for row in judged])
    print(f"\n{good} of {len(ratios)} between 0.5 and 2, {far} off by more than a factor of 4, {wrong} of the wrong "
          f"sign, the least {min(ratios, default=0):.2f}, the largest {max(ratios, default=0):.2f}; "
          f"{len(rows) - len(judged)} apart. Parts cancel in {sum(cancels(row) for row in judged)}. The signed sums "
          f"alone: {sums[0]} between 0.5 and 2, {sums[1]} off by more than a factor of 4, {sums[2]} of the wrong sign")


if __name__ == "__main__":
    fill_scenes(__doc__, "error", COLUMNS, records, CASES, table)

"""A failed step leaves nothing behind: a run with cutbacks equals, bit for bit on one rank, one that is given the same steps from the start, penalties that follow the penetration included."""
import h5py
import numpy

from harness import Check, arguments, run, SCENES

args = arguments()
check = Check()
cup = SCENES.parent.parent / "runs" / "cup_flattening.yaml"
COLUMNS = ("t", "dt", "residual", "contact_nodes", "nodes_in", "nodes_out", "max_penetration", "min_penetration", "outside_window", "penalty_min", "penalty_max", "contact_force", "plane_force", "contact_radius", "apex_thickness")
for when in ("step", "converged"):
    # Five iterations are too few for long steps; dt is a quarter and its halves, so that the texts of steps.csv are the exact load parameters.
    common = (f"contact.0.penalty={{adjust: true, when: {when}, g_min: 1e-6, g_max: 5e-6, unit: length}}", "solver.max_iterations=5")
    cut = run(args, cup, out=f"cut_{when}", overrides=(*common, "stepping={control: fixed, initial: 0.25}"))
    at = [row["t"] for row in cut.steps()]
    given = run(args, cup, out=f"given_{when}", overrides=(*common, f"stepping={{control: fixed, initial: 1, at: {at}}}"))
    check.holds(f"{when}: steps failed", cut.summary()["steps_failed"] > 5, str(cut.summary()["steps_failed"]))
    check.holds(f"{when}: the given steps did not", given.summary()["steps_failed"] == 0)
    for name in COLUMNS:
        check.holds(f"{when}: {name}", [row[name] for row in cut.steps()] == [row[name] for row in given.steps()])
    check.holds(f"{when}: counts", cut.summary()["contact"] == given.summary()["contact"])
    differ = []
    with h5py.File(cut.directory / "results.h5", "r") as a, h5py.File(given.directory / "results.h5", "r") as b:
        a.visititems(lambda name, item: differ.append(name) if isinstance(item, h5py.Dataset) and not numpy.array_equal(item[()], b[name][()], equal_nan=item.dtype.kind == "f") else None)
    check.holds(f"{when}: every field of every step", not differ, " ".join(differ))
check.finish()

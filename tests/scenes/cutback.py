"""A failed step leaves nothing behind: a run with cutbacks equals, bit for bit on one rank, one that is given the same
steps from the start, penalties that follow the penetration and offsets of either kind included."""
import h5py
import numpy

from harness import Check, arguments, run, SCENES

args = arguments()
check = Check()
COLUMNS = ("t", "dt", "residual", "contact_nodes", "nodes_in", "nodes_out", "max_penetration", "min_penetration",
           "outside_window", "penalty_min", "penalty_max", "contact_force")
# Too few iterations for long steps; dt is a quarter and its halves, so that the texts of steps.csv are the exact load
# parameters. What else the scene shows; how often it is cut at least.
CASES = {
    f"penalties, {when}": ("cup_flattening", [
        f"contact.0.penalty={{adjust: true, when: {when}, g_min: 1e-6, g_max: 5e-6, unit: length}}",
        "solver.max_iterations=3"
    ], ("plane_force", "contact_radius", "apex_thickness"), 0)
    for when in ("step", "converged")
}
PIPE = [
    "mesh.order=1",
    "probes=[{name: force, reaction: plate_top, component: y}]", "contact.0.smoother=diffuse",
    "contact.0.formulation=surface_to_surface"
]
for offset, around, most, squeeze, failures in (("held", 6, 1, 45, 1), ("live", 8, 3, 70, 0)):
    CASES[f"{offset} offsets"] = ("pipe_pinch", [
        *PIPE, f"mesh.parameters={{n_arc: {around}, n_wall: 1, n_len: 2}}", f"contact.0.offset={offset}",
        f"solver.max_iterations={most}", f"loads.0.uy=-{squeeze}"
    ], ("force",), failures)
CASES["factors with a border"] = ("pipe_pinch", [
    "mesh.parameters={n_arc: 18, n_wall: 1, n_len: 8}", "loads.0.uy=-50",
    "probes=[{name: force, reaction: plate_top, component: y}]", "contact.0.smoother=diffuse", "contact.0.degree=2",
    "solver.max_iterations=2"
], ("force",), 0)
for name, (scene, common, shown, failures) in CASES.items():
    path, folder = SCENES.parent.parent / "runs" / f"{scene}.yaml", name.replace(", ", "_").replace(" ", "_")
    cut = run(args, path, out=f"cut_{folder}", overrides=(*common, "stepping={control: fixed, initial: 0.25}"))
    at = [row["t"] for row in cut.steps()]
    given = run(args, path, out=f"given_{folder}",
                overrides=(*common, f"stepping={{control: fixed, initial: 1, at: {at}}}"))
    check.holds(f"{name}: steps failed", cut.summary()["steps_failed"] > failures, str(cut.summary()["steps_failed"]))
    check.holds(f"{name}: the given steps did not",
                given.summary()["steps_failed"] == 0, str(given.summary()["steps_failed"]))
    for column in (*COLUMNS, *shown):
        check.holds(f"{name}: {column}", [row[column] for row in cut.steps()] == [row[column] for row in given.steps()])
    check.holds(f"{name}: counts", cut.summary()["contact"] == given.summary()["contact"])
    differ = []
    with h5py.File(cut.directory / "results.h5", "r") as a, h5py.File(given.directory / "results.h5", "r") as b:
        a.visititems(lambda item_name, item: differ.append(item_name) if isinstance(item, h5py.Dataset) and not numpy.
                     array_equal(item[()], b[item_name][()], equal_nan=item.dtype.kind == "f") else None)
    check.holds(f"{name}: every field of every step", not differ, " ".join(differ))
check.finish()

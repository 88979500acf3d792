"""The spherical cup on a plane: reference answers halfway and at the end, first touch, with second- and first-order
elements."""
from harness import Check, arguments, run, SCENES

REFERENCE = {
    0.5: {
        "plane_force": (116900, 130),
        "contact_radius": (17.33, 0.1)
    },
    1: {
        "plane_force": (434500, 400),
        "contact_radius": (25.10, 0.1),
        "apex_thickness": (1.9246, 1e-4)
    }
}
MESH = 0.005  # what a mesh may add to the estimated error of the reference, which another code gave; of the value
OPEN, CLOSED, PRESSURE = 4.6, 4.8, 200  # MPa: before and after the first touch, at t = 1

args = arguments()
check = Check()
for order, n_arc in ((2, 60), (1, 120)):
    finished = run(
        args, SCENES.parent.parent / "runs" / "cup_flattening.yaml", out=f"order_{order}", overrides=[
            f"mesh.order={order}", f"mesh.parameters.n_arc={n_arc}",
            f"stepping.at=[{OPEN / PRESSURE:g}, {CLOSED / PRESSURE:g}, 0.5]"
        ])
    rows = {round(row["t"], 9): row for row in finished.steps()}
    check.holds(f"order {order}: open at {OPEN} MPa, one node in contact at {CLOSED}",
                [rows[P / PRESSURE]["contact_nodes"] for P in (OPEN, CLOSED)] == [0, 1])
    for t, probes in REFERENCE.items():
        for probe, (reference, error) in probes.items():
            check.near(f"order {order}: {probe} at t = {t:g}", rows[t][probe], reference, error + MESH * reference)
check.finish()

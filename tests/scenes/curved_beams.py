"""An elastoplastic half ring is dragged over another one, with friction: forces against the table of Neto et al.
(2016), which is for another mesh, and against elements of second order, the own limit of the mesh; facets beside the smooth
surface, and the same without friction."""
import numpy

from harness import Check, arguments, run, SCENES

TRAVEL = 31.5
AT = numpy.array([3, 6, 9, 12, 15, 18, 21, 24, 27, 30])
# On the upper ring; the table has the opposite signs, those of the lower one.
X = numpy.array([8.89, 13.37, 15.12, 16.00, 16.74, 17.20, 16.72, 11.12, -2.09, -1.49])
Y = -numpy.array([7.55, 13.39, 17.56, 21.05, 24.33, 28.23, 32.73, 38.77, 26.51, 5.72])
CASES = {
    "first order": [],
    "second order": ["mesh.order=2"],
    "facets": ["contact.0.smoother=facet"],
    "without friction": ["contact.0.friction.mu=0"],
    "facets without friction": ["contact.0.friction.mu=0", "contact.0.smoother=facet"],
}
args = arguments()
check = Check()
found = {}
for name, overrides in CASES.items():
    facets = name.startswith("facets")
    finished = run(args, SCENES / "curved_beams.yaml", out=name.replace(" ", "_"), overrides=overrides, must=None)
    summary, steps = finished.summary(), finished.steps()
    u = [TRAVEL * row["t"] for row in steps]
    found[name] = [numpy.interp(AT, u, [row[key] for row in steps]) for key in ("force_x", "force_y")]
    print(f"     {name}: to u = {u[-1]:.2f}, {summary['steps']} steps, {summary['steps_failed']} failed, "
          f"{summary['newton_iterations']} iterations")
    for key, values in zip("xy", found[name]):
        print(f"     force {key}", " ".join(f"{value:7.2f}" for value in values))
    if not facets:
        check.holds(f"{name}: gets to the end", finished.status == 0)
# Up to 21 the rings press on each other; from 24 on they slip off, and forces change by their own size within one unit.
pressed = AT <= 21
for key, values, table in zip("xy", found["first order"], (X, Y)):
    check.near(f"force {key}: the table, up to 21", values[pressed] / table[pressed], 1, 0.035)
for key, one, two in zip("xy", found["first order"], found["second order"]):
    check.near(f"force {key}: as second order", one / numpy.max(numpy.abs(two)), two / numpy.max(numpy.abs(two)), 0.01)
check.finish()

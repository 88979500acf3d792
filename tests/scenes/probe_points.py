"""Probes at points between nodes: in a block that is compressed along one axis alone they have the displacement in closed
form; points outside of bodies, and of two bodies, are refused."""
from harness import Check, arguments, run, SCENES

args = arguments()
check = Check()
HEIGHT, MOTION = 12, -2
POINTS = ((3.37, 5.21), (17.77, 11.03), (0.123, 0.456))


def refused(what, text, scene, *points):
    finished = run(args, SCENES / scene, "-check", out="refused", must=1,
                   overrides=["probes=[{name: u, displacement: [%g, %g], component: y}]" % points])
    check.holds(what, text in finished.text, finished.text.strip()[-300:])


probes = [{"name": f"u{k}", "displacement": [*point], "component": "y"} for k, point in enumerate(POINTS)]
for order in (1, 2):
    both = {"name": "d", "distance": [[*POINTS[0]], [*POINTS[1]]]}
    found = run(args, SCENES / "confined.yaml", out=f"points_{order}",
                overrides=[f"mesh.order={order}", f"probes={[*probes, both]}"]).summary()["probes"]
    for k, (_, y) in enumerate(POINTS):
        check.near(f"order {order}: displacement at point {k}", found[f"u{k}"] / MOTION, y / HEIGHT, 1e-3)
    (x_0, y_0), (x_1, y_1) = POINTS[:2]
    distance = ((x_1 - x_0)**2 + ((y_1 - y_0) * (1 + MOTION / HEIGHT))**2)**0.5
    check.near(f"order {order}: distance of two points", found["d"] / distance, 1, 1e-3)
refused("a point outside", "no body at (30, 1); allowed: reference coordinates of a point of a body", "confined.yaml",
        30, 1)
refused("a point of two bodies", "several bodies are at (0.05, 0)", "box.yaml", 0.05, 0)
check.finish()

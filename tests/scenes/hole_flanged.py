"""The hole of a plate of sheet is flanged by a ball that comes and leaves, with friction: the sheet springs back as
soon as the ball leaves, and no step fails there, though the ball moves by many faces in each; elements of both orders
agree in the flange that remains."""
from harness import Check, arguments, run, SCENES

LEAVES, DEPTH = 0.9, 9.8  # t where the ball leaves; depth of the hole's edge after it, only a scale
args = arguments()
check = Check()
edges = {}
for order in (1, 2):
    finished = run(args, SCENES / "hole_flanged.yaml", "-quiet", out=f"order_{order}",
                   overrides=[f"mesh.order={order}"])
    steps, probes = finished.steps(), finished.summary()["probes"]
    away = [row for row in steps if row["t"] > LEAVES + 1e-9]
    check.holds(f"order {order}: no step fails when the ball leaves", all(row["attempts"] == 1 for row in away),
                f"{len(away)} steps, {sum(row['newton'] for row in away):.0f} iterations")
    check.holds(f"order {order}: it leaves in few iterations", away[0]["newton"] <= 20, f"{away[0]['newton']:.0f}")
    edges[order] = probes["edge_x"], probes["edge_y"]
    print(f"     edge at {edges[order]}")
for i, name in enumerate(("x", "y")):
    check.near(f"edge_{name}: orders agree", (edges[1][i] - edges[2][i]) / DEPTH, 0, 0.01)
check.finish()

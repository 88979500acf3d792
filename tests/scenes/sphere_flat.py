"""A ball of elastic-perfectly plastic material on a rigid plane, without friction, E/Y = 1000: the force over the approach
against the fit of Kogut and Etsion, Journal of Applied Mechanics 69 (2002): P/P_c = 1.03 (w/w_c)^1.425 up to 6 and
1.40 (w/w_c)^1.263 up to 110, with w_c and P_c of the first yield. The fit of Jackson and Green, Journal of Tribology 127
(2005), is printed beside it. The mesh with half the elements along each
direction is within 1.5 %; one with 2e-4 beside 3e-4 is within 0.6 % (measured, too long for a test)."""
import sys

from harness import Check, arguments, run, SCENES

sys.path.insert(0, str(SCENES.parent.parent / "scripts"))
from forming_table import jackson_green, kogut_etsion, P_C, W_C  # noqa: E402

WAYS = (2, 6, 10, 50)
MESHES = {"fine": ("{h: 3e-4, growth: 0.06}", 0.05), "half": ("{h: 6e-4, growth: 0.12}", 0.05)}

args = arguments()
check = Check()
found = {}
for name, (mesh, allowed) in MESHES.items():
    finished = run(args, SCENES / "sphere_flat.yaml", "-quiet", out=name, overrides=[f"mesh.parameters={mesh}"])
    steps, summary = finished.steps(), finished.summary()
    for way in WAYS:
        row = min(steps, key=lambda row: abs(row["t"] * 110 - way))
        force, fit = row["force"] / P_C, kogut_etsion(way)
        found[name, way] = force
        check.near(f"{name}, {way} w_c", force / fit, 1, allowed)
        other = row["force"] / jackson_green(way * W_C) - 1
        print(f"     {row['contact_nodes']:.0f} nodes in contact, {100 * other:+.1f} % from Jackson and Green")
    check.holds(f"{name}: no step failed", summary["steps_failed"] == 0,
                f"{summary['steps']} steps, {summary['newton_iterations']} iterations")
for way in WAYS:
    check.near(f"meshes agree, {way} w_c", found["half", way] / found["fine", way], 1, 0.015)
check.finish()

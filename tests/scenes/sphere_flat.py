"""A ball of elastic-perfectly plastic material on a rigid plane, without friction, E/Y = 1000: the force over the approach
against the fit of Kogut and Etsion, Journal of Applied Mechanics 69 (2002): P/P_c = 1.03 (w/w_c)^1.425 up to 6 and
1.40 (w/w_c)^1.263 up to 110, with w_c and P_c of the first yield. The fit of Jackson and Green, Journal of Tribology 127
(2005), is printed beside it. The mesh with half the elements along each
direction is within 1.5 %; one with 2e-4 beside 3e-4 is within 0.6 % (measured, too long for a test)."""
import math

from harness import Check, arguments, run, SCENES

E, NU, Y = 200e3, 0.3, 200
MODULUS, K = E / (1 - NU**2), 0.454 + 0.41 * NU
W_C = (math.pi * K * 2.8 * Y / (2 * MODULUS))**2
P_C = 2 / 3 * K * 2.8 * Y * math.pi * W_C
WAYS = (2, 6, 10, 50)
MESHES = {"fine": ("{h: 3e-4, growth: 0.06}", 0.05), "half": ("{h: 6e-4, growth: 0.12}", 0.05)}


def jackson_green(w):
    c = 1.295 * math.exp(0.736 * NU)
    w_c, p_c = (math.pi * c * Y / (2 * MODULUS))**2, 4 / 3 / MODULUS**2 * (c / 2 * math.pi * Y)**3
    s = w / w_c
    if s < 1.9:
        return p_c * s**1.5
    a = math.sqrt(w * (s / 1.9)**(0.14 * math.exp(23 * Y / MODULUS)))
    hardness = 2.84 * (1 - math.exp(-0.82 * a**-0.7))
    return p_c * (math.exp(-0.25 * s**(5 / 12)) * s**1.5 + 4 * hardness / c * (1 - math.exp(-s**(5 / 9) / 25)) * s)


args = arguments()
check = Check()
found = {}
for name, (mesh, allowed) in MESHES.items():
    finished = run(args, SCENES / "sphere_flat.yaml", "-quiet", out=name, overrides=[f"mesh.parameters={mesh}"])
    steps, summary = finished.steps(), finished.summary()
    for way in WAYS:
        row = min(steps, key=lambda row: abs(row["t"] * 110 - way))
        force, fit = row["force"] / P_C, 1.03 * way**1.425 if way <= 6 else 1.40 * way**1.263
        found[name, way] = force
        check.near(f"{name}, {way} w_c", force / fit, 1, allowed)
        other = row["force"] / jackson_green(way * W_C) - 1
        print(f"     {row['contact_nodes']:.0f} nodes in contact, {100 * other:+.1f} % from Jackson and Green")
    check.holds(f"{name}: no step failed", summary["steps_failed"] == 0,
                f"{summary['steps']} steps, {summary['newton_iterations']} iterations")
for way in WAYS:
    check.near(f"meshes agree, {way} w_c", found["half", way] / found["fine", way], 1, 0.015)
check.finish()

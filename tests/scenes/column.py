"""A straight column that is pressed beyond its critical loads is in equilibrium, but not in a stable one. The run counts
the critical loads that it has passed. Those of a column that is clamped at both ends are k^2 E I / L^2 with kL = 2 pi,
8.987, 4 pi, 15.451, 6 pi (Timoshenko and Gere, Theory of elastic stability, 2nd ed., section 2.4): the stretch of the
k-th is (kL)^2/12 (h/L)^2, whatever the law."""
import math

from harness import Check, arguments, run, SCENES

args = arguments()
check = Check()
scene = SCENES / "column.yaml"
CRITICAL = [root**2 / 12 / 100**2 for root in (2 * math.pi, 8.987, 4 * math.pi, 15.451, 6 * math.pi)]
FRICTION = "contact.0.friction={mu: 0.2}"
RUBBER = ("bodies.0.material={law: mooney_rivlin, c10: 5, c01: 1, nu: 0.5}", "bodies.0.formulation=mixed")


def column(name, *overrides):
    return run(args, scene, out=name, overrides=overrides)


def stability(run):
    return run.summary()["stability"]


# Between two critical loads each: the middle of their stretches; on several ranks with none and with two passed.
for passed, (low, high) in enumerate(zip([0] + CRITICAL, CRITICAL)):
    if args.ranks > 1 and passed not in (0, 2):
        continue
    straight = column(f"passed_{passed}", f"loads.0.ux={-50 * (low + high)}")
    check.holds(f"{passed} critical loads passed", stability(straight)["negative_eigenvalues"] == passed,
                str(stability(straight)))
check.holds("of large energy: told", "but in an unstable equilibrium" in column("far", "loads.0.ux=-1").text)
check.holds("below the first: not told", "unstable" not in column("below", "loads.0.ux=-0.02").text)

between = f"loads.0.ux={-50 * (CRITICAL[1] + CRITICAL[2])}"
rubber = column("incompressible", *RUBBER, between)
check.holds("incompressible: two passed", stability(rubber)["negative_eigenvalues"] == 2, str(stability(rubber)))
for name, ux, unstable in (("below", -50 * CRITICAL[0], 0), ("beyond", -50 * (CRITICAL[1] + CRITICAL[2]), 1)):
    rubs = column(f"friction_{name}", FRICTION, f"loads.0.ux={ux}")
    check.holds(f"friction, {name}", stability(rubs)["negative_eigenvalues"] == unstable, str(stability(rubs)))

# A small load leads one way, and damping leads to the stable equilibrium of that way: Euler's column stays near its
# first critical load.
BENT = ("loads=[{surface: right, ux: -0.15}, {volume: column, body_force: [0, -0.001]}]",
        "stepping={damping: auto, initial: 0.5}")
for name, options in (("plain", ()), ("friction", (FRICTION, ))):
    bent = column(f"bent_{name}", *BENT, *options)
    force = 70000 / (1 - 0.3**2) * CRITICAL[0]
    check.near(f"bent, {name}: force", -bent.summary()["probes"]["push"] / force, 1, 0.03)
    check.holds(f"bent, {name}: stable", stability(bent)["negative_eigenvalues"] == 0, str(stability(bent)))
check.finish()

"""A bar pulled and pressed in turn, with backstresses and an overstress: force and plastic work are those of the law in
one dimension, for every kind of element that keeps its volume. Its rate equations are integrated here in many small
steps.
With an overstress the reference takes the steps of the run, by the backward Euler method as the run does; that the
law itself is Perzyna's is shown by unit/test_backstress.c."""
import sys

import numpy

from harness import Check, arguments, run, SCENES

sys.path.insert(0, str(SCENES.parent.parent / "scripts"))
from plastic_law_table import cyclic_path, E, HISTORY, LAWS, LENGTH, NU, WAY  # noqa: E402

# element -> order, simplices, formulations
ELEMENTS = {"hex8": (1, 0, ("fbar", "enhanced", "mixed")), "hex27": (2, 0, ("full", "mixed")),
            "tet10": (2, 1, ("mixed",))}

args = arguments(("kinematics", "of the scene", ["small", "finite"]), ("element", "of the bar", ELEMENTS))
check = Check()
order, tet, formulations = ELEMENTS[args.element]
finite = args.kinematics == "finite"
for name, law in LAWS.items():
    for formulation in formulations:
        overrides = [f"kinematics={args.kinematics}", f"mesh.order={order}", f"mesh.parameters.tet={tet}",
                     f"bodies.0.formulation={formulation}",
                     f"loads.0={{surface: x_max, ux: {WAY}, history: {HISTORY}}}",
                     f"bodies.0.material={{law: von_mises, E: {E}, nu: {NU}, {law[0]}}}",
                     f"stepping={{control: fixed, initial: {0.01 if law[3] else 0.02}}}"]
        finished = run(args, SCENES / "plastic_bar.yaml", "-quiet", out=f"{name}_{formulation}", overrides=overrides)
        steps, what = finished.steps(), f"{name}, {formulation}"
        expected = list(cyclic_path(finite, law, [row["t"] for row in steps]))
        stretch = 1 + WAY / LENGTH * numpy.interp([row["t"] for row in steps], *zip(*HISTORY))
        force = [stress / (value if finite else 1) for (stress, _, _), value in zip(expected, stretch)]
        largest = max(abs(value) for value in force)
        check.near(f"{what}: force", [row["force"] for row in steps], force, (1e-6 if law[3] else 2e-3) * largest)
        check.near(f"{what}: plastic strain", steps[-1]["max_plastic_strain"], expected[-1][1], 1e-3 * expected[-1][1])
        growth = max(after[1] - before[1] for before, after in zip([(0, 0, 0), *expected], expected))
        check.near(f"{what}: largest growth in a step", finished.summary()["max_plastic_growth"], growth, 1e-2 * growth)
        work = expected[-1][2] * LENGTH
        check.near(f"{what}: plastic work", finished.summary()["energy"]["plastic"], work, 5e-3 * work)
        check.holds(f"{what}: no step failed", finished.summary()["steps_failed"] == 0)
        print(f"{what}: {finished.summary()['newton_iterations']} iterations in {len(steps)} steps")
check.finish()

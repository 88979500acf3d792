"""A bar pulled and pressed in turn, with backstresses and an overstress: force and plastic work are those of the law in
one dimension, for every kind of element that keeps its volume. Its rate equations are integrated here in many small
steps.
With an overstress the reference takes the steps of the run, by the backward Euler method as the run does; that the
law itself is Perzyna's is shown by unit/test_backstress.c."""
import math

import numpy

from harness import Check, arguments, run, SCENES

E, NU, LENGTH, WAY = 200e3, 0.3, 2, 0.04
HISTORY = [[0, 0], [0.2, 1], [0.4, -1], [0.6, 1], [0.8, -0.5], [1, 0.2]]
SUBSTEPS = 400  # of a load step, for the reference without an overstress


def chaboche(a):
    return 200 + 100 * (1 - math.exp(-12 * a))


LAWS = {  # material keys, yield stress over the plastic strain, backstresses, overstress
    "chaboche": ("yield: 200, hardening: {voce: {saturation: 300, rate: 12}}, kinematic: [{C: 40e3, gamma: 500}, "
                 "{C: 5e3, gamma: 40}, {C: 500}]", chaboche, [(40e3, 500), (5e3, 40), (500, 0)], None),
    "prager": ("yield: 250, kinematic: [{C: 3e3}]", lambda a: 250, [(3e3, 0)], None),
    "perzyna": ("yield: 200, hardening: {linear: 500}, perzyna: {overstress: 100, speed: 0.4, power: 3}",
                lambda a: 200 + 500 * a, [], (100, 0.4, 3)),
    "all": ("yield: 200, hardening: {linear: 500}, kinematic: [{C: 5e3}], "
            "perzyna: {overstress: 100, speed: 0.4, power: 1}", lambda a: 200 + 500 * a, [(5e3, 0)], (100, 0.4, 1)),
}
# element -> order, simplices, formulations
ELEMENTS = {"hex8": (1, 0, ("fbar", "enhanced", "mixed")), "hex27": (2, 0, ("full", "mixed")),
            "tet10": (2, 1, ("mixed",))}


def rate(excess, overstress):
    bound, speed, power = overstress
    return speed * (excess / bound)**power if excess > 0 else 0


def path(finite, law, times):
    """Stress, equivalent plastic strain and plastic work at the times, by the rate equations."""
    _, flow, terms, overstress = law
    backstress, plastic, a, work, before = [0.0] * len(terms), 0.0, 0.0, 0.0, 0.0
    substeps = 1 if overstress else SUBSTEPS
    for time in times:
        moments = numpy.linspace(before, time, substeps + 1)[1:]
        factors = numpy.interp(moments, *zip(*HISTORY))
        strains = WAY / LENGTH * factors
        strains = numpy.log1p(strains) if finite else strains
        for strain in strains:
            stress = E * (strain - plastic)
            sign = math.copysign(1, stress - sum(backstress))
            excess = sign * (stress - sum(backstress)) - flow(a)
            if excess <= 0:
                continue
            slope = E + (flow(a + 1e-6) - flow(a)) / 1e-6
            slope += sum(C - sign * g * x for (C, g), x in zip(terms, backstress))
            if overstress:  # implicit in the excess
                dt, least, most = (time - before) / substeps, 0.0, excess / slope
                for _ in range(100):
                    p = (least + most) / 2
                    least, most = (p, most) if rate(excess - slope * p, overstress) * dt > p else (least, p)
            p = (least + most) / 2 if overstress else excess / slope
            work += p * (sign * E * (strain - plastic - sign * p) - p * (slope - E) / 2)
            plastic, a = plastic + sign * p, a + p
            backstress = [x + p * (sign * C - g * x) for (C, g), x in zip(terms, backstress)]
        before = time
        yield E * (strain - plastic), a, work


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
        expected = list(path(finite, law, [row["t"] for row in steps]))
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

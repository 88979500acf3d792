"""A bar of one stress in tension and back: force, plastic strain and energies are those of the law in one dimension, for
every element, formulation and hardening. A point in tension obeys stress = E (strain - plastic strain) with logarithmic
strains and Kirchhoff stresses (finite strains) or engineering ones (small strains)."""
import math

from harness import Check, arguments, run, SCENES

E, NU, LENGTH = 200e3, 0.3, 2
TABLE = [(0, 451), (0.006, 476), (0.019, 525), (0.038, 583), (0.066, 642), (0.147, 710), (0.5, 777), (1, 831)]


def table(a):
    for (a_0, y_0), (a_1, y_1) in zip(TABLE, TABLE[1:]):
        if a <= a_1:
            return y_0 + (y_1 - y_0) * (a - a_0) / (a_1 - a_0)
    raise ValueError(a)


HARDENING = {
    "none": ({"yield": 450}, lambda a: 450),
    "linear": ({"yield": 450, "hardening": "{linear: 261.2}"}, lambda a: 450 + 261.2 * a),
    "voce": ({"yield": 450, "hardening": "{linear: 129, voce: {saturation: 715, rate: 16.93}}"},
             lambda a: 450 + 129 * a + 265 * (1 - math.exp(-16.93 * a))),
    "swift": ({"yield": 450, "hardening": "{swift: {strength: 900, exponent: 0.2}}"},
              lambda a: 900 * (0.5**5 + a)**0.2),
    "table": ({"hardening": f"{{table: {[list(row) for row in TABLE]}}}"}, table),
}
# element -> order, simplices; hexahedra of first order in each formulation
ELEMENTS = {"hex8": (1, 0, ("fbar", "enhanced", "full", "mixed")), "hex27": (2, 0, ("full", "mixed")), "tet4": (1, 1, ("full",)),
            "tet10": (2, 1, ("full", "mixed"))}


def increase(strain, a, flow):
    """Plastic strain a after the bar is brought to a strain, stress there, by bisection."""
    plastic, least = a[0], 0
    stress = E * (strain - plastic)
    if abs(stress) <= flow(a[1]):
        return a, stress
    most = (abs(stress) - flow(a[1])) / E
    for _ in range(200):
        middle = (least + most) / 2
        if abs(stress) - E * middle > flow(a[1] + middle):
            least = middle
        else:
            most = middle
    sign = math.copysign(1, stress)
    return (plastic + sign * least, a[1] + least), stress - sign * E * least


def path(finite, flow, steps):
    """Force per unit area of the undeformed section and equivalent plastic strain at every step."""
    a = (0, 0)
    for row in steps:
        t = row["t"]
        stretch = 0.6 / LENGTH * (2 * t if t <= 0.5 else 1 - 0.2 * (t - 0.5))
        a, stress = increase(math.log1p(stretch) if finite else stretch, a, flow)
        yield (stress / (1 + stretch) if finite else stress), a[1], stress


args = arguments(("kinematics", "of the scene", ["small", "finite"]), ("element", "of the bar", ELEMENTS))
check = Check()
order, tet, formulations = ELEMENTS[args.element]
for name, (material, flow) in HARDENING.items():
    for formulation in formulations:
        overrides = [f"kinematics={args.kinematics}", f"mesh.order={order}", f"mesh.parameters.tet={tet}",
                     f"bodies.0.formulation={formulation}"]
        keys = {"law": "von_mises", "E": E, "nu": NU, **material}
        overrides.append("bodies.0.material={" + ", ".join(f"{key}: {value}" for key, value in keys.items()) + "}")
        finished = run(args, SCENES / "plastic_bar.yaml", "-quiet", out=f"{name}_{formulation}", overrides=overrides)
        steps, what = finished.steps(), f"{name}, {formulation}"
        expected = list(path(args.kinematics == "finite", flow, steps))
        largest = max(abs(force) for force, _, _ in expected)
        check.near(f"{what}: force", [row["force"] for row in steps], [force for force, _, _ in expected],
                   1e-7 * largest)
        check.near(f"{what}: plastic strain", [row["max_plastic_strain"] for row in steps],
                   [strain for _, strain, _ in expected], 1e-7)
        strain, stress = expected[-1][1:]
        n = 2000
        work = sum(flow(strain * (i + 0.5) / n) * strain / n for i in range(n)) * LENGTH
        check.near(f"{what}: plastic work", finished.summary()["energy"]["plastic"], work, 1e-4 * work)
        elastic = stress**2 / (2 * E) * LENGTH
        check.near(f"{what}: elastic energy", finished.summary()["energy"]["elastic"], elastic, 1e-6 * elastic)
        tensor = finished.fields()["plastic_strain_tensor"]
        stretch = 0.9 * 0.6 / LENGTH
        plastic = (math.log1p(stretch) if args.kinematics == "finite" else stretch) - stress / E
        check.near(f"{what}: plastic strain tensor", tensor, [plastic, -plastic / 2, -plastic / 2, 0, 0, 0], 1e-7)
        field = finished.fields()["plastic_strain"]
        check.near(f"{what}: field", field, strain, 1e-7)
        check.holds(f"{what}: no step failed", finished.summary()["steps_failed"] == 0)
        print(f"{what}: {finished.summary()['newton_iterations']} iterations in {len(steps)} steps")
check.finish()

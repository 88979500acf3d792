"""A bar of one stress in tension and back: force, plastic strain and energies are those of the law in one dimension,
for every element, formulation and hardening. A point in tension obeys stress = E (strain - plastic strain) with
logarithmic strains and Kirchhoff stresses (finite strains) or engineering ones (small strains)."""
import math
import sys

from harness import Check, arguments, run, SCENES

sys.path.insert(0, str(SCENES.parent.parent / "scripts"))
from plastic_law_table import E, HARDENING, LENGTH, NU, tension_path  # noqa: E402

# element -> order, simplices; hexahedra of first order in each formulation
ELEMENTS = {"hex8": (1, 0, ("fbar", "enhanced", "full", "mixed")), "hex27": (2, 0, ("full", "mixed")),
            "tet4": (1, 1, ("full",)), "tet10": (2, 1, ("full", "mixed"))}

args = arguments(("kinematics", "of the scene", ["small", "finite"]), ("element", "of the bar", ELEMENTS),
                 ("formulations", "each hardening with all of them, or with one, in turn", ["all", "turn"]))
check = Check()
order, tet, formulations = ELEMENTS[args.element]
for place, (name, (material, flow)) in enumerate(HARDENING.items()):
    for formulation in formulations if args.formulations == "all" else (formulations[place % len(formulations)], ):
        overrides = [f"kinematics={args.kinematics}", f"mesh.order={order}", f"mesh.parameters.tet={tet}",
                     f"bodies.0.formulation={formulation}"]
        keys = {"law": "von_mises", "E": E, "nu": NU, **material}
        overrides.append("bodies.0.material={" + ", ".join(f"{key}: {value}" for key, value in keys.items()) + "}")
        finished = run(args, SCENES / "plastic_bar.yaml", "-quiet", out=f"{name}_{formulation}", overrides=overrides)
        steps, what = finished.steps(), f"{name}, {formulation}"
        expected = list(tension_path(args.kinematics == "finite", flow, steps))
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

"""The plate on plane facets of one degree: smoothed, they answer as the exact cylinder does; the same plate mesh, the
same fixed penalty."""
from harness import Check, arguments, run, SCENES

MESH = "mesh.parameters={h_contact: 0.5, h_far: 5, n_thick: 2, n_width: 4"
COMMON = ["mesh.order=1", "contact.0.penalty={initial: auto, scale: 100}"]
BOUND = {2: 1e-4, 4: 1e-6}  # largest relative difference of a probe to the exact cylinder's, by degree

args = arguments()
check = Check()
runs = SCENES.parent.parent / "runs"
exact = run(args, runs / "plate_cylinder.yaml", out="exact", overrides=[*COMMON, MESH + "}"]).summary()["probes"]
for turn in (0, 0.5):
    for degree in (0, *BOUND):
        smoother = ["contact.0.smoother=diffuse", f"contact.0.degree={degree}"
                    ] if degree else ["contact.0.smoother=facet"]
        name = f"degree_{degree}-turn_{turn}" if degree else f"facet-turn_{turn}"
        probes = run(args, runs / "plate_cylinder_meshed.yaml", out=name,
                     overrides=[*COMMON, f"{MESH}, cylinder: 1, turn: {turn}}}", *smoother]).summary()["probes"]
        error = max(abs(probes[key] / exact[key] - 1) for key in exact)
        if degree:
            check.holds(f"{name}: probes", error <= BOUND[degree],
                        f"relative error {error:.2e}, allowed {BOUND[degree]:.0e}")
        else:
            print(f"     {name}: relative error {error:.2e}")
check.finish()

"""The ladder of fall-backs of a fit, rung by rung, as -check counts them: masters with ever fewer rows of facets carry
ever simpler fits, and one facet none."""
import re

from harness import Check, arguments, run, SCENES

PLATE = SCENES.parent.parent / "runs" / "plate_cylinder_meshed.yaml"
ROWS = ["contact.0.smoother=diffuse", "mesh.order=1", "mesh.parameters.n_width=2"]
CASES = {  # rungs on which slave points stand
    "six rows": (PLATE, ROWS + ["mesh.parameters.n_cylinder_z=6"], {"plain", "wider"}),
    "two rows": (PLATE, ROWS + ["mesh.parameters.n_cylinder_z=2"], {"degree 2"}),
    "one row of a body": (SCENES / "contact_patch.yaml", ["contact.0.smoother=diffuse", "contact.0.symmetry=[]",
                                                          "mesh.parameters.n_lower=6",
                                                          "mesh.parameters.n_depth_lower=1"], {"linear"}),
    "one row of a tool, which is divided": (PLATE, ROWS + ["mesh.parameters.n_cylinder_z=1"], {"plain", "wider"}),
    "one facet": (SCENES / "contact_patch.yaml", ["contact.0.smoother=diffuse", "contact.0.symmetry=[]", "mesh.parameters.n_lower=1",
                                                  "mesh.parameters.n_depth_lower=1"], {"facets"}),
    "six rows, quadrature points": (PLATE, ROWS + ["mesh.parameters.n_cylinder_z=6",
                                                   "contact.0.formulation=surface_to_surface"], {"plain"}),
}

args = arguments()
check = Check()
for name, (scene, overrides, expected) in CASES.items():
    text = run(args, scene, "-check", out=name.replace(" ", "_"), overrides=overrides).text
    total, counts = re.search(r"fits of (\d+) slave points: (.*)", text).groups()
    standing = {rung: int(n) for rung, n in re.findall(r"([a-z]+(?: 2)?) (\d+)", counts)}
    check.holds(f"{name}: every slave point stands somewhere", sum(standing.values()) == int(total) > 0, f"{standing}")
    check.holds(f"{name}: on {' and '.join(sorted(expected))}", {rung
                                                                 for rung, n in standing.items()
                                                                 if n} == expected, f"{standing}")
check.finish()

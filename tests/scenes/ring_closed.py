"""Rigid jaws that close radially around a ring, axisymmetric, against Lame's solution for pressure from outside: the
force that moves them, and the displacement of the bore. What is left is the error that the run states."""
import math

from harness import Check, arguments, run, SCENES

E, NU, A, B, HEIGHT, CLOSED = 1000, 0.3, 4, 6, 3, 0.01  # CLOSED: by how much the outer radius becomes smaller
PRESSURE = CLOSED * E * (B**2 - A**2) / (B * (1 + NU) * ((1 - 2 * NU) * B**2 + A**2))
FORCE = 2 * math.pi * B * HEIGHT * PRESSURE
BORE = 2 * PRESSURE * A * B**2 * (1 - NU**2) / (E * (B**2 - A**2))
PENETRATION, MESH = 2e-3, {"1": 3e-3, "2": 3e-4}  # parts of the force; the mesh's error falls as h^2 and h^4

args = arguments(("formulation", "of contact", ["node_to_surface", "surface_to_surface"]),
                 ("order", "of the elements", ["1", "2"]))
check = Check()
finished = run(args, SCENES / "ring_closed.yaml", overrides=[
    f"mesh.order={args.order}", f"contact.0.formulation={args.formulation}",
    f"mesh.parameters.n={8 if args.order == '1' else 4}"
])
probes = finished.summary()["probes"]
allowed = PENETRATION + MESH[args.order]
check.near("force that moves the jaws inwards", probes["force"], -FORCE, allowed * FORCE)
check.near("is the opposite of the force on them", probes["force"], -probes["master"], 1e-12 * FORCE)
check.near("nothing along the axis", probes["along"], 0, 1e-6 * FORCE)
check.near("displacement of the bore", probes["bore"], -BORE, allowed * BORE)
check.finish()

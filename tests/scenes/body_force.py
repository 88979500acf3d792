"""A bar that hangs from its upper end under its own weight: with Poisson's ratio 0 the displacement is (f / E) (y^2 -
L^2) / 2, the lower end goes down by f L^2 / 2E, and the support carries the weight (Timoshenko and Goodier, Theory
of Elasticity, article 86). Elements of second order hold such a displacement exactly, on any mesh with straight
edges."""
import math

from harness import Check, arguments, run, SCENES

E, F, LENGTH = 1000.0, 3.0, 1.0  # stress, force per volume (density times gravity), length of the bar along y
BARS = {  # scene, parameters of its mesh, further supports, components of the force, volume
    "plane strain": ("patch_plane.yaml", ["geometry=plane_strain"], "", "", 2.0),
    "plane strain, triangles": ("patch_plane.yaml", ["geometry=plane_strain", "mesh.parameters.tri=1"], "", "", 2.0),
    "axisymmetric": ("patch_plane.yaml", ["geometry=axisymmetric"], "", "", math.pi * 2**2),
    "solid": ("patch.yaml", [], ", {surface: z_min, uz: 0}", ", 0", 2 * 1.5),
    "solid, tetrahedra": ("patch.yaml", ["mesh.parameters.tet=1"], ", {surface: z_min, uz: 0}", ", 0", 2 * 1.5),
}

args = arguments()
check = Check()
for name, (scene, overrides, supports, zero, volume) in BARS.items():
    finished = run(
        args, SCENES / scene, out=name.replace(", ", "_").replace(" ", "_"), overrides=[
            *overrides, "mesh.order=2", "kinematics=small", f"bodies.0.material={{law: linear, E: {E}, nu: 0}}",
            f"supports=[{{surface: y_max, uy: 0}}, {{surface: x_min, ux: 0}}{supports}]",
            f"loads=[{{volume: block, body_force: [0, {-F}{zero}]}}]",
            "probes=[{name: carried, reaction: y_max, component: y}]"
        ])
    fields = finished.fields()
    y, largest = fields["nodes"][:, 1], F * LENGTH**2 / (2 * E)
    check.near(f"{name}: displacement along y", fields["displacement"][:, 1], F / E * (y**2 - LENGTH**2) / 2,
               1e-10 * largest)
    check.near(f"{name}: displacement along x", fields["displacement"][:, 0], 0, 1e-10 * largest)
    check.near(f"{name}: lower end", fields["displacement"][:, 1].min(), -largest, 1e-10 * largest)
    check.near(f"{name}: weight", finished.summary()["probes"]["carried"], F * volume, 1e-10 * F * volume)
check.finish()

"""Principal stresses with their directions, strain, energy density, contact traction and status in the results, against
closed forms: sheared and stretched blocks of every geometry, a bar that sticks and slips."""
import numpy

from harness import Check, arguments, run, SCENES

FIELDS = "output={fields: [displacement, stress, contact, principal, strain]}"


def near(what, found, exact, allowed=1e-9):
    check.near(what, found, numpy.broadcast_to(exact, found.shape), allowed)


def sheared(geometry, order):
    """A homogeneous shear of g: stress tau, principal stresses +-tau under 45 degrees."""
    g, e, nu = 0.01, 1000, 0.3
    tau = e / 2 / (1 + nu) * g
    solid = geometry == "solid"
    surfaces = ("x_min", "x_max", "y_min", "y_max") + (("z_min", "z_max") if solid else ())
    rest = ", uz: 0" if solid else ""
    finished = run(args, SCENES / ("patch.yaml" if solid else "patch_plane.yaml"), out="sheared", overrides=[
        f"geometry={geometry}", f"mesh.order={order}", "kinematics=small",
        f"bodies.0.material={{law: linear, E: {e}, nu: {nu}}}", "supports=[]", FIELDS, "loads=[" +
        ", ".join(f'{{surface: {s}, ux: "{g}*y*t", uy: "0*t"{rest}}}' for s in surfaces) + "]"
    ])
    fields = finished.fields()
    name = f"shear, {geometry}, order {order}"
    near(f"{name}: principal stresses", fields["principal_stress"] / tau, [1, 0, -1])
    near(f"{name}: first direction", fields["principal_direction_1"], numpy.array([1, 1, 0]) / numpy.sqrt(2))
    near(f"{name}: last direction", numpy.abs(fields["principal_direction_3"]), numpy.array([1, 1, 0]) / numpy.sqrt(2))
    near(f"{name}: strain", fields["strain"] / g, [0, 0, 0, 0.5, 0, 0])
    near(f"{name}: energy density", fields["energy_density"] / (tau * g / 2), 1)
    return finished


def stretched(geometry, formulation):
    """Uniaxial tension at large strain, where the energy density is the integral of the nominal stress: logarithmic
    strains of the stretches."""
    stretch = 1.5
    solid = geometry == "solid"
    axis = "y"
    sides = "xyz" if solid else "xy" if geometry == "plane_stress" else "y"
    supports = [f"{{surface: {s}_min, u{s}: 0}}" for s in sides]
    finished = run(args, SCENES / ("patch.yaml" if solid else "patch_plane.yaml"), out="stretched", overrides=[
        f"geometry={geometry}", "bodies.0.material={law: mooney_rivlin, c10: 1, c01: 0.2, K: 20}",
        f"bodies.0.formulation={formulation}", FIELDS, f"supports=[{', '.join(supports)}]",
        f"loads=[{{surface: {axis}_max, uy: {stretch - 1}}}]", "stepping={control: fixed, initial: 0.02}",
        "solver.tolerance=1e-9",
        f"probes=[{{name: force, reaction: {axis}_max, component: y}}]"
    ])
    fields, steps = finished.fields(), finished.steps()
    t = numpy.array([0] + [row["t"] for row in steps])
    force = numpy.array([0] + [row["force"] for row in steps])
    area = {"solid": 3.0, "plane_stress": 2.0, "axisymmetric": 4 * numpy.pi}[geometry]
    work = (t[2::2] - t[:-2:2]) @ (force[:-2:2] + 4 * force[1:-1:2] + force[2::2]) / 6 * (stretch - 1) / area
    u, x = fields["displacement"], fields["nodes"]
    lateral = 1 + u[numpy.argmax(x[:, 0]), 0] / x[:, 0].max()
    name = f"stretch, {geometry}, {formulation}"
    near(f"{name}: energy density over work", fields["energy_density"] / work, 1, 1e-6)
    strain = numpy.log([lateral, stretch, lateral])
    near(f"{name}: logarithmic strain", fields["strain"], [*strain, 0, 0, 0], 1e-7)
    near(f"{name}: first principal stress", fields["principal_stress"][:, 0] / fields["stress"][:, 1], 1)


def contact():
    """A block is pressed on a plane and pushed, without and with friction: traction on the slave and status."""
    base = ["kinematics=small", "bodies.0.material={law: linear, E: 1000, nu: 0}", "solver.tolerance=1e-9",
            "supports=[]", "probes=[]"]
    plane = "master: {plane: {point: [0, 0, 0], normal: [0, 1, 0]}}"
    for friction, push, status in (("", 0, 2), (", friction: {mu: 0.3}", 0.5, 1)):
        supports = "supports=[{surface: z_min, uz: 0}" + (", {surface: x_min, ux: 0}]" if not push else "]")
        finished = run(args, SCENES / "patch.yaml", out="contact", overrides=[
            *base, supports, f"loads=[{{surface: y_max, traction: [{push}, -5, 0]}}]",
            "contact=[{name: pair, slave: y_min, smoother: facet, penalty: {initial: 1e5, scale: 1}, "
            f"{plane}{friction}}}]"
        ])
        fields = finished.fields()
        bottom = fields["nodes"][:, 1] < 1e-9
        name = f"contact{', friction' if friction else ''}"
        near(f"{name}: status on the slave", fields["status"][bottom], status)
        near(f"{name}: status elsewhere", fields["status"][~bottom], 0)
        traction = fields["contact_traction"]
        along = fields["pressure"][bottom, None] * fields["normal"][bottom]
        near(f"{name}: traction is pressure along the normal and friction", traction[bottom],
             along + (fields["traction"][bottom] if friction else 0))
        if not friction:
            near(f"{name}: traction", traction[bottom], [0, 5, 0], 1e-5)
        near(f"{name}: none elsewhere", traction[~bottom], 0)


args = arguments()
check = Check()
for form, order_ in (("solid", 1), ("solid", 2), ("plane_strain", 1), ("plane_strain", 2), ("plane_stress", 2)):
    last = sheared(form, order_)
check.holds("results.xdmf has them", all(f'Name="{n}"' in (last.directory / "results.xdmf").read_text()
                                          for n in ("principal_stress", "strain_xy", "energy_density")))
for form, kind in (("solid", "full"), ("solid", "mixed"), ("axisymmetric", "full"), ("plane_stress", "full")):
    stretched(form, kind)
contact()
check.finish()

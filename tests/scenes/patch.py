"""Patch test: a linear displacement imposed on the boundary, and tractions of a uniform shear, give uniform stress on a
distorted mesh."""
import numpy

from harness import Check, arguments, run, SCENES

E, NU = 1000, 0.3
LAMBDA, MU = E * NU / (1 + NU) / (1 - 2 * NU), E / 2 / (1 + NU)
SIDES = {"x": 2, "y": 1, "z": 1.5}
STRETCH = {"x": 0.1, "y": -0.06, "z": 0.04}  # strains of the imposed displacement
SHEAR = 3.0  # shear stress of the traction test
ELEMENTS = {
    "tri3": (1, 1),
    "tri6": (1, 2),
    "quad4": (0, 1),
    "quad9": (0, 2),
    "tet4": (1, 1),
    "tet10": (1, 2),
    "hex8": (0, 1),
    "hex27": (0, 2)
}
FORMULATIONS = {
    "enhanced": ("quad4", "hex8"),
    "fbar": ("quad4", "hex8"),
    "mixed": ("tri6", "quad4", "quad9", "tet10", "hex8", "hex27")
}


def stretched(geometry, kinematics):
    """Cauchy stress (xx yy zz xy yz xz) of the stretch. Axisymmetric: the hoop direction, zz, stretches as r."""
    e = numpy.array([
        STRETCH["x"], STRETCH["y"], {
            "solid": STRETCH["z"],
            "plane_strain": 0,
            "axisymmetric": STRETCH["x"]
        }[geometry]
    ])
    if kinematics == "finite" and formulation == "mixed":  # neo_hookean
        s = (MU * ((1 + e) ** 2 - 1) + LAMBDA * numpy.log(numpy.prod(1 + e))) / numpy.prod(1 + e)
    elif kinematics == "small":
        s = LAMBDA * e.sum() + 2 * MU * e
    else:
        green = ((1 + e) ** 2 - 1) / 2
        s = (LAMBDA * green.sum() + 2 * MU * green) * (1 + e) ** 2 / numpy.prod(1 + e)
    return numpy.array([*s, 0, 0, 0])


def stretch(args, check, kinematics):
    axes = "xyz" if args.geometry == "solid" else "xy"
    loads = ", ".join(f"{{surface: {a}_max, u{a}: {STRETCH[a] * SIDES[a]}}}" for a in axes)
    supports = ", ".join(f"{{surface: {a}_min, u{a}: 0}}" for a in axes)
    fields = run(args, scene, out=f"stretch_{kinematics}",
                 overrides=[*overrides, f"kinematics={kinematics}", f"loads=[{loads}]",
                            f"supports=[{supports}]"]).fields()
    exact = numpy.zeros_like(fields["nodes"])
    for i, a in enumerate(axes):
        exact[:, i] = STRETCH[a] * fields["nodes"][:, i]
    dim = fields["displacement"].shape[1]
    check.near(f"stretch, {kinematics}: displacement", fields["displacement"], exact[:, :dim], 1e-10)
    check.near(f"stretch, {kinematics}: stress", fields["stress"], stretched(args.geometry, kinematics), 1e-8 * E)


def shear(args, check):
    zero = ", 0" if args.geometry == "solid" else ""
    faces = {
        "x_max": f"[0, {SHEAR}{zero}]",
        "x_min": f"[0, {-SHEAR}{zero}]",
        "y_max": f"[{SHEAR}, 0{zero}]",
        "y_min": f"[{-SHEAR}, 0{zero}]"
    }
    loads = ", ".join(f"{{surface: {face}, traction: {value}}}" for face, value in faces.items())
    supports = "{surface: origin, ux: 0, uy: 0}, {surface: end_x, uy: 0}"
    if args.geometry == "solid":
        supports = "{surface: origin, ux: 0, uy: 0, uz: 0}, {surface: end_x, uy: 0, uz: 0}, {surface: end_y, uz: 0}"
    fields = run(args, scene, out="shear",
                 overrides=[*overrides, "kinematics=small", f"loads=[{loads}]", f"supports=[{supports}]"]).fields()
    exact = numpy.zeros_like(fields["displacement"])
    exact[:, 0] = SHEAR / MU * fields["nodes"][:, 1]
    check.near("shear: displacement", fields["displacement"], exact, 1e-10)
    check.near("shear: stress", fields["stress"], numpy.array([0, 0, 0, SHEAR, 0, 0]), 1e-8 * E)


args = arguments(("element", "element type, hex8_enhanced: with that formulation",
                  [*ELEMENTS, *(f"{e}_{f}" for f, elements in FORMULATIONS.items() for e in elements)]),
                 ("geometry", "of the scene", ["solid", "plane_strain", "axisymmetric"]))
element, _, formulation = args.element.partition("_")
simplex, order = ELEMENTS[element]
if args.geometry == "solid":
    scene, overrides = SCENES / "patch.yaml", [f"mesh.parameters.tet={simplex}"]
else:
    scene, overrides = SCENES / "patch_plane.yaml", [f"mesh.parameters.tri={simplex}"]
overrides += [f"mesh.order={order}", f"geometry={args.geometry}", f"bodies.0.formulation={formulation or 'full'}"]
if formulation == "mixed":
    overrides += ["bodies.0.material.law=neo_hookean"]
check = Check()
stretch(args, check, "finite")
if args.geometry == "axisymmetric":
    stretch(args, check, "small")
else:
    shear(args, check)
check.finish()

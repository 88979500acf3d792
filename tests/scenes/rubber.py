"""A block of rubber under uniaxial, equibiaxial and planar tension and compression: each law against its closed form
with the lateral stretches solved for, to 1e-8, with a bulk modulus and incompressible; in the plane and axisymmetric as
far as these have the tests."""
import itertools
import math

from harness import Check, arguments, run, SCENES
from rubberlaws import LAWS, principal

BULK = 50
STRETCHES = (0.6, 1.8)


def incompressible(law, test, stretch):
    """The nominal stress in x. The lateral stretch keeps the volume, and the pressure frees it of stress."""
    lateral = {"uniaxial": stretch**-0.5, "equibiaxial": stretch**-2, "planar": 1 / stretch}[test]
    other = {"uniaxial": lateral, "equibiaxial": stretch, "planar": 1}[test]
    kirchhoff = principal(law, (stretch, other, lateral), 0)
    return (kirchhoff[0] - kirchhoff[2]) / stretch


def nominal(law, test, stretch):
    """The nominal stress in x. The lateral stretch has no stress: bisection."""
    def stretches(lateral):
        return {"uniaxial": (stretch, lateral, lateral), "equibiaxial": (stretch, stretch, lateral),
                "planar": (stretch, 1, lateral)}[test]

    low, high = 0.1, 5
    while high - low > 1e-15 * high:
        middle = (low + high) / 2
        if middle in (low, high):
            break
        low, high = (low, middle) if principal(law, stretches(middle), BULK)[2] > 0 else (middle, high)
    return principal(law, stretches(low), BULK)[0] / stretch


def overrides(test, stretch):
    pulled = {"uniaxial": "x", "equibiaxial": "xy", "planar": "x"}[test]
    loads = ", ".join(f"{{surface: {axis}_max, u{axis}: {stretch - 1}}}" for axis in pulled)
    changed = [f"loads=[{loads}]"]
    return changed + (["supports.3={surface: y_max, uy: 0}"] if test == "planar" else [])


args = arguments(("law", "of the material", LAWS),
                 ("geometry", "of the scene", ("solid", "plane_strain", "axisymmetric")),
                 ("order", "of the elements", ("1", "2")))
check = Check()
TESTS = {"solid": ("uniaxial", "equibiaxial", "planar"), "plane_strain": ("planar",), "axisymmetric": ("uniaxial",)}
VOLUMES = {f"K: {BULK}": nominal, "incompressible: true": incompressible}
for test, stretch, volume in itertools.product(TESTS[args.geometry], STRETCHES, VOLUMES):
    common = [f"bodies.0.material={{law: {args.law}, {LAWS[args.law]}, {volume}}}", f"mesh.order={args.order}",
              f"geometry={args.geometry}"]
    force = VOLUMES[volume](args.law, test, stretch)
    if args.geometry == "solid":
        common += overrides(test, stretch)
    else:
        common += ["mesh={file: ../../meshes/square.geo, order: " + args.order + "}"]
        axial, free = ("x", "y") if args.geometry == "plane_strain" else ("y", "x")
        common += [f"supports=[{{surface: {axial}_min, u{axial}: 0}}, {{surface: {free}_min, u{free}: 0}}]",
                   f"loads=[{{surface: {axial}_max, u{axial}: {stretch - 1}}}]",
                   f"probes=[{{name: force, reaction: {axial}_max, component: {axial}}}]"]
        force *= math.pi if args.geometry == "axisymmetric" else 1
    finished = run(args, SCENES / "rubber.yaml", out=f"{test}_{stretch}_{volume[0]}", overrides=common)
    check.near(f"{test} {stretch}, {volume}", finished.summary()["probes"]["force"], force, 1e-8 * max(1, abs(force)))
check.finish()

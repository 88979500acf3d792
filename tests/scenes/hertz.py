"""Line contact of a cylinder and a block: force exact, half-width and peak pressure within 1 % of Hertz's with the
diffuse smoother of either degree and either body as slave; the noise of the pressure about its ellipse, with facets
beside it. Surface to surface with a small load: the run starts from the one node that touches, on graded and on coarse
second-order meshes, and gives the peak to 1.5 % and the edge to a fifth of a face; with three second-order elements in
even rows, moved nodes and a stiffer penalty the peak to 1 %. So does the point contact of a sphere that nothing else
holds the edge, and on quadrilaterals as a mesher lays them to 0.3 of a face."""
import numpy

from harness import Check, arguments, run, SCENES

FORCE, HALF_WIDTH, PEAK = 17500, 6.215, 3585.4  # half of 35 kN per mm; mm, MPa
BOUND = 0.01
COARSE = 0.015  # of the peak, with three second-order faces along the half-width; measured: 1.1 %
INNER = 0.8  # the part of the half-width on which the noise is measured: next to the edge the ellipse falls too steeply
# largest deviation from the ellipse; measured: 0.2 to 0.6 %, facets 2 % (block as slave) and 12 % (cylinder)
NOISE = 0.01
SLAVES = {"block": [], "cylinder": ["contact.0.slave=cylinder_sole", "contact.0.master=block_top"]}


def noise(fields):
    """Largest deviation of the inner nodes' pressure from the half-ellipse fitted to them (p^2 is linear in x^2)."""
    x, pressure = fields["nodes"][fields["contact/line/nodes"], 0], fields["contact/line/pressure"]
    inner = (pressure > 0) & (x < INNER * HALF_WIDTH)
    line = numpy.polyfit(x[inner] ** 2, pressure[inner] ** 2, 1)
    return float(numpy.max(numpy.abs(pressure[inner] / numpy.sqrt(numpy.polyval(line, x[inner] ** 2)) - 1)))


args = arguments()
check = Check()
for slave, swap in SLAVES.items():
    for smoother, degree in (("diffuse", 4), ("diffuse", 2), ("facet", 4)):
        name = f"{slave} as slave, {smoother}" + (f" {degree}" if smoother == "diffuse" else "")
        finished = run(args, SCENES.parent.parent / "runs" / "hertz_line.yaml", out=name.replace(" ",
                                                                                                 "_").replace(",", ""),
                       overrides=[f"contact.0.smoother={smoother}", f"contact.0.degree={degree}", *swap])
        probes, deviation = finished.summary()["probes"], noise(finished.fields())
        check.near(f"{name}: force", probes["force"], FORCE, 1e-6 * FORCE)
        if smoother == "diffuse":
            check.near(f"{name}: half-width", probes["half_width"] / HALF_WIDTH, 1, BOUND)
            check.near(f"{name}: peak pressure", probes["peak_pressure"] / PEAK, 1, BOUND)
            check.holds(f"{name}: noise", deviation <= NOISE, f"{100 * deviation:.2f} %, allowed {100 * NOISE:.0f} %")
        print(
            f"     half-width {probes['half_width']:.4f} ({100 * (probes['half_width'] / HALF_WIDTH - 1):+.2f} %), "
            f"peak pressure {probes['peak_pressure']:.1f} ({100 * (probes['peak_pressure'] / PEAK - 1):+.2f} %), noise "
            f"{100 * deviation:.2f} %"
        )
for order, faces in ((1, 12), (2, 3)):  # elements of the block along the half-width, which is 1
    name, scale = f"surface to surface, order {order}", HALF_WIDTH**2
    mesh = ["formulation=surface_to_surface", "penalty.scale=100"]
    probes = run(
        args, SCENES.parent.parent / "runs" / "hertz_line.yaml", out=f"surface_{order}", overrides=[
            f"mesh.order={order}", f"mesh.parameters={{h: {1 / (0.8 * faces):.8g}, zone: 1.3}}",
            f"loads.0.pressure={350 / scale:.8g}", *(f"contact.0.{value}" for value in mesh)
        ]).summary()["probes"]
    check.near(f"{name}: force", probes["force"], FORCE / scale, 1e-6 * FORCE / scale)
    check.near(f"{name}: half-width", probes["half_width"], 1, 0.2 / faces)
    check.near(f"{name}: peak pressure", probes["peak_pressure"] / PEAK * HALF_WIDTH, 1, COARSE)
probes = run(
    args, SCENES.parent.parent / "runs" / "hertz_line.yaml", out="rows", overrides=[
        "mesh.order=2", f"mesh.parameters={{h: {1 / (0.8 * 3):.8g}, zone: 1.3, core: 1.3, growth: 0.5, jitter: 0.25}}",
        f"loads.0.pressure={350 / HALF_WIDTH**2:.8g}", "contact.0.formulation=surface_to_surface",
        "contact.0.penalty.scale=1000"
    ]).summary()["probes"]
check.near("even rows, moved nodes: peak pressure", probes["peak_pressure"] / PEAK * HALF_WIDTH, 1, BOUND)
force = 1.50240 * 16 * 16  # a quarter of the sphere
for name, faces, share, mesh in (("sphere", 2, 0.2, []), ("sphere, free", 3, 0.3,
                                                          ["mesh.file=../meshes/hertz_sphere_free.geo"
                                                           ])):  # faces along the radius, which is 1
    probes = run(args, SCENES.parent.parent / "runs" / "hertz_sphere.yaml", out=name.replace(", ", "_"),
                 overrides=[*mesh, f"mesh.parameters.n={faces}"]).summary()["probes"]
    check.near(f"{name}: force", probes["force"], force, 1e-6 * force)
    check.near(f"{name}: radius", probes["radius"], 1, share / faces)
joined = run(args, SCENES.parent.parent / "runs" / "hertz_sphere.yaml", out="joined",
             overrides=["mesh.file=../meshes/hertz_sphere_free.geo", "mesh.parameters={n: 2, apart: 0}"])
check.holds("bodies that the mesher has joined are told of", "have 1 node in common" in joined.text, "no warning")
check.finish()

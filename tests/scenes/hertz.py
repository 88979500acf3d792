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


def run_line(args, out, overrides):
    return run(args, SCENES.parent.parent / "runs" / "hertz_line.yaml", out=out, overrides=overrides)


def line(args, check):
    for slave, swap in SLAVES.items():
        for smoother, degree in (("diffuse", 4), ("diffuse", 2), ("facet", 4)):
            name = f"{slave} as slave, {smoother}" + (f" {degree}" if smoother == "diffuse" else "")
            finished = run_line(args, name.replace(" ", "_").replace(",", ""),
                                [f"contact.0.smoother={smoother}", f"contact.0.degree={degree}", *swap])
            probes, deviation = finished.summary()["probes"], noise(finished.fields())
            width, peak = probes["half_width"] / HALF_WIDTH, probes["peak_pressure"] / PEAK
            percent = f"{100 * deviation:.2f} %"
            check.near(f"{name}: force", probes["force"], FORCE, 1e-6 * FORCE)
            if smoother == "diffuse":
                check.near(f"{name}: half-width", width, 1, BOUND)
                check.near(f"{name}: peak pressure", peak, 1, BOUND)
                check.holds(f"{name}: noise", deviation <= NOISE, f"{percent}, allowed {100 * NOISE:.0f} %")
            print(f"     half-width {100 * (width - 1):+.2f} %, peak {100 * (peak - 1):+.2f} %, noise {percent}")


def coarse(args, check):
    for order, faces in ((1, 12), (2, 3)):  # elements of the block along the half-width, which is 1
        name, scale = f"surface to surface, order {order}", HALF_WIDTH**2
        probes = run_line(args, f"surface_{order}", [
            f"mesh.order={order}", f"mesh.parameters={{h: {1 / (0.8 * faces):.8g}, zone: 1.3}}",
            f"loads.0.pressure={350 / scale:.8g}", "contact.0.formulation=surface_to_surface",
            "contact.0.penalty.scale=100"
        ]).summary()["probes"]
        check.near(f"{name}: force", probes["force"], FORCE / scale, 1e-6 * FORCE / scale)
        check.near(f"{name}: half-width", probes["half_width"], 1, 0.2 / faces)
        check.near(f"{name}: peak pressure", probes["peak_pressure"] / PEAK * HALF_WIDTH, 1, COARSE)
    mesh = f"{{h: {1 / (0.8 * 3):.8g}, zone: 1.3, core: 1.3, growth: 0.5, jitter: 0.25}}"
    probes = run_line(args, "rows", [
        "mesh.order=2", f"mesh.parameters={mesh}", f"loads.0.pressure={350 / HALF_WIDTH**2:.8g}",
        "contact.0.formulation=surface_to_surface", "contact.0.penalty.scale=1000"
    ]).summary()["probes"]
    check.near("even rows, moved nodes: peak pressure", probes["peak_pressure"] / PEAK * HALF_WIDTH, 1, BOUND)


def sphere(args, check):
    scene, free = SCENES.parent.parent / "runs" / "hertz_sphere.yaml", "mesh.file=../meshes/hertz_sphere_free.geo"
    force = 1.50240 * 16 * 16  # a quarter of the sphere
    # faces along the radius, which is 1
    for name, faces, share, mesh in (("sphere", 2, 0.2, []), ("sphere, free", 3, 0.3, [free])):
        probes = run(args, scene, out=name.replace(", ", "_"),
                     overrides=[*mesh, f"mesh.parameters.n={faces}"]).summary()["probes"]
        check.near(f"{name}: force", probes["force"], force, 1e-6 * force)
        check.near(f"{name}: radius", probes["radius"], 1, share / faces)
    joined = run(args, scene, out="joined", overrides=[free, "mesh.parameters={n: 2, apart: 0}"])
    check.holds("bodies that the mesher has joined are told of", "have 1 node in common" in joined.text, "no warning")


args, check = arguments(("case", "which contact", ("line", "coarse", "sphere"))), Check()
{"line": line, "coarse": coarse, "sphere": sphere}[args.case](args, check)
check.finish()

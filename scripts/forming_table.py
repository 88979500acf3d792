"""Metal forming: runs the scenes of forming that are in tests/scenes and runs, leaves steps, iterations and the forces,
places and angles that have a reference in a record, and prints the table; --print tables an existing record, --case
runs one case and keeps the others of the record, --variant only those of its variants whose name the pattern is in.
    python scripts/forming_table.py [--burnish BINARY] [--record FILE] [--case "curved beams"]"""
import math
import re
import shutil
import subprocess

import numpy

from launch import (ROOT, command, environment, read_records, read_steps, read_summary, replace_records,
                    table_parser)

SCENES = ROOT / "tests/scenes"
COLUMNS = ("case", "variant", "t", "quantity", "value", "reference", "source", "status", "steps", "failed",
           "iterations")
E, NU, Y = 200e3, 0.3, 200  # of the ball
BALL_LIMIT = {2: 2.772, 6: 12.81, 10: 25.40, 50: 197.5}  # P/P_c over w/w_c on the finest mesh below
K, MODULUS = 0.454 + 0.41 * NU, E / (1 - NU**2)
W_C = (math.pi * K * 2.8 * Y / (2 * MODULUS))**2
P_C = 2 / 3 * K * 2.8 * Y * math.pi * W_C
STEEL = "{law: von_mises, E: 200e3, nu: 0.3, yield: 300, hardening: {linear: 1000}}"
ELASTIC = "{law: svk, E: 200e3, nu: 0.3}"
BEAMS = {3: (8.89, -7.55), 6: (13.37, -13.39), 9: (15.12, -17.56), 12: (16.00, -21.05), 15: (16.74, -24.33),
         18: (17.20, -28.23), 21: (16.72, -32.73), 24: (11.12, -38.77), 27: (-2.09, -26.51), 30: (-1.49, -5.72)}
BILLET = {0.1: 245261, 0.2: 270257, 0.3: 298239, 0.4: 330615, 0.5: 367790, 0.6: 406405, 0.7: 469336, 0.8: 552340,
          0.9: 663023, 1: 828794}  # tests/jobs/forming_calculix.py, CAX8, 100 increments
NECK, NECK_LARGEST = 6.297566, (76721, 5.775)  # tests/jobs/plastic_calculix.py, CAX8R, 400 increments, FLAT
NECKS = {3: (73609, 6.1133), 5: (76384, 5.9109), 7: (73402, 5.5296), 8: (69340, 5.2068), 9: (64431, 4.8419),
         10: (58005, 4.4243), 11: (50181, 3.9474), 12: (41019, 3.4069), 13: (30634, 2.7964), 14: (19573, 2.1122)}
HILL = {"young": 21000, "yield": 24, "inner": 1, "outer": 2, "bore": 0.02}  # of plastic_cylinder.yaml


def row_at(steps, t):
    at = int(numpy.argmin(numpy.abs(steps["t"] - t)))
    return {key: values[at] for key, values in steps.items()}


def kogut_etsion(way):
    """P/P_c of a ball on a plane at an approach of way times w_c."""
    return 1.03 * way**1.425 if way <= 6 else 1.40 * way**1.263


def jackson_green(w):
    """P of a ball on a plane at an approach w."""
    c = 1.295 * math.exp(0.736 * NU)
    w_c, p_c = (math.pi * c * Y / (2 * MODULUS))**2, 4 / 3 / MODULUS**2 * (c / 2 * math.pi * Y)**3
    s = w / w_c
    if s < 1.9:
        return p_c * s**1.5
    a = math.sqrt(w * (s / 1.9)**(0.14 * math.exp(23 * Y / MODULUS)))
    hardness = 2.84 * (1 - math.exp(-0.82 * a**-0.7))
    return p_c * (math.exp(-0.25 * s**(5 / 12)) * s**1.5 + 4 * hardness / c * (1 - math.exp(-s**(5 / 9) / 25)) * s)


def ball(steps):
    for way in (2, 6, 10, 50):
        fit, row = kogut_etsion(way), row_at(steps, way / 50)
        yield way / 50, f"P/P_c at {way} w_c", row["force"] / P_C, fit, "Kogut and Etsion 2002"
        yield (way / 50, f"P/P_c at {way} w_c", row["force"] / P_C, jackson_green(way * W_C) / P_C,
               "Jackson and Green 2005")
        yield way / 50, f"nodes in contact at {way} w_c", row["contact_nodes"], None, ""


def plate(steps):
    for way, limit in BALL_LIMIT.items():
        row = row_at(steps, way / 110)
        yield way / 110, f"P/P_c at {way} w_c", row["force"] / P_C, limit, "own limit"


def ring(steps):
    loaded, after = row_at(steps, 0.5), row_at(steps, 1)
    yield 0.5, "force", loaded["force"], 77.796, "CalculiX"
    yield 1, "springback of the top", after["height"] - loaded["height"], 20.4506 - 18.9638, "CalculiX"
    yield 1, "springback of the side", after["width"] - loaded["width"], 14.0466 - 14.6611, "CalculiX"


def vee(steps):
    def angle(row):
        return math.degrees(math.atan2(row["end_y"] - row["mid_y"], 5 + row["end_x"] - row["mid_x"]))

    yield 0.5, "angle under load", angle(row_at(steps, 0.5)), None, ""
    yield 1, "angle after it", angle(row_at(steps, 1)), None, ""


def billet(steps):
    end = row_at(steps, 1)
    yield 1, "force on a die", end["force"] + end["die"], None, ""


def billet_way(steps):
    for t, force in BILLET.items():
        yield t, "force on a die", numpy.interp(t, steps["t"], steps["force"] + steps["die"]), force, "CalculiX"


def bar(steps):
    way, largest = 14 * steps["t"], numpy.argmax(steps["force"])
    yield steps["t"][largest], "largest force", steps["force"][largest], NECK_LARGEST[0], "CalculiX"
    yield steps["t"][largest], "its elongation", way[largest], NECK_LARGEST[1], "CalculiX"
    for at, (force, radius) in NECKS.items():
        yield at / 14, f"force at {at} mm", numpy.interp(at, way, steps["force"]), force, "CalculiX"
        yield at / 14, f"neck at {at} mm", NECK + numpy.interp(at, way, steps["neck"]), radius, "CalculiX"


def hill(bore):
    """Pressure on an incompressible cylinder whose bore is displaced."""
    shear, plane, a, b = HILL["young"] / 3, 2 * HILL["yield"] / math.sqrt(3), HILL["inner"], HILL["outer"]
    c = min(b, math.sqrt(4 * shear * a * bore / plane))
    return 2 * shear * a * bore * (1 / a**2 - 1 / b**2) if c <= a else plane * (math.log(c / a) + (1 - c**2 / b**2) / 2)


def cylinder(steps):
    """The pressure is the work over what the bore sweeps: that of the middle of each step."""
    bore, work = HILL["bore"] * numpy.append(0, steps["t"]), numpy.append(0, steps["work"])
    pressure = numpy.diff(work) / (math.pi / 2 * HILL["inner"] * numpy.diff(bore))
    expected = [(hill(before) + hill(after)) / 2 for before, after in zip(bore, bore[1:])]
    worst = numpy.argmax(numpy.abs(pressure - expected))
    yield steps["t"][worst], "pressure where it is furthest off", pressure[worst], expected[worst], "Hill 1950"
    yield 1, "limit pressure", pressure[-1], hill(bore[-1]), "Hill 1950"


def free_beams(steps):
    """Without friction the source has no table."""
    for u in BEAMS:
        for key in ("force_x", "force_y"):
            if u <= 31.5 * steps["t"][-1]:
                yield u / 31.5, key, numpy.interp(u / 31.5, steps["t"], steps[key]), None, ""


def beams(steps):
    for t, key, value, _, _ in free_beams(steps):
        yield t, key, value, BEAMS[round(31.5 * t)][key == "force_y"], "Neto et al. 2016"


def pipe(steps):
    yield 1, "plate_force", row_at(steps, 1)["plate_force"], None, ""


CASES = [("ball on a plane", f"h {h}, {steps}", SCENES / "sphere_flat.yaml",
          [f"mesh.parameters={{h: {h}, growth: {200 * float(h):g}, near: 0.03, far: 0.12}}",
           f"loads.0.uy={-50 * W_C:.6g}",
           f"stepping={{initial: {min(dt, 0.01)}, dt_max: {dt}, at: [0.02, 0.04, 0.12, 0.2, 0.4]}}"], ball)
         for h, steps, dt in (("1.5e-4", "100 steps", 0.01), ("3e-4", "100 steps", 0.01), ("6e-4", "100 steps", 0.01),
                              ("3e-4", "default steps", 1))]
PLATE = ["supports=[{surface: plate_base, ux: 0, uy: 0}]",
         "bodies.1={volume: plate, material: {law: svk, E: 200e6, nu: 0.3}}"]
CASES += [("ball on a plate", f"{smoother}, order {order}, h {h}", SCENES / "sphere_flat.yaml",
           [f"mesh.order={order}", f"mesh.parameters={{h: {h}, growth: {200 * float(h):g}, plate: 0.05}}", *PLATE,
            f"contact.0={{name: flat, slave: plate_top, master: skin, smoother: {smoother}}}"], plate)
          for order in (1, 2) for smoother in ("facet", "diffuse") for h in ("2.4e-3", "1.2e-3", "6e-4", "3e-4")]
CASES += [("ring between plates", name, SCENES / "ring_springback.yaml", ["stepping.at=[0.5]", *own], ring)
          for name, own in (("default steps", []), ("dt 0.02", ["stepping.dt_max=0.02"]),
                            ("full integration, dt 0.02", ["stepping.dt_max=0.02", "bodies.0.formulation=full"]))]
CASES += [("vee die", name, SCENES / "vee_bend.yaml", own, vee)
          for name, own in (("100 x 8, fbar", []),
                            ("200 x 16, fbar", ["mesh.parameters.nx=200", "mesh.parameters.ny=16"]),
                            ("100 x 8, second order", ["mesh.order=2"]))]
CASES += [("upset billet", name, SCENES / "upset.yaml", own, billet)
          for name, own in (("default steps", []), ("plastic_lag 0", ["stepping.plastic_lag=0"]),
                            *((f"plastic_strain {bound}", [f"stepping.plastic_strain={bound}"])
                              for bound in (0.2, 0.1, 0.05, 0.01)))]
CASES += [("upset billet", "second order, full integration, plastic_strain 0.02", SCENES / "upset.yaml",
           ["mesh.order=2", "mesh.parameters.ny=16", "bodies.0.formulation=full", "stepping.plastic_strain=0.02"],
           billet_way)]
HALF = ["stepping.initial=0.005", "stepping.dt_max=0.0079"]
FACET, NODES = "contact.0.smoother=facet", "contact.0.formulation=node_to_surface"
SWAP = ["contact.0.slave=lower_outer", "contact.0.master=upper_outer"]


def grid(arc, wall, order, apart=0.001):
    return [f"mesh.order={order}", f"mesh.parameters={{n_arc: {arc}, n_wall: {wall}, apart: {apart}}}"]


CASES += [("curved beams", f"{name}, mu {mu}", SCENES / "curved_beams.yaml", [f"contact.0.friction.mu={mu}", *own],
           figures)
          for mu, figures in ((0.3, beams), (0, free_beams)) for name, own in (
              ("smooth", []), ("facets", [FACET]), ("facets, node to surface", [FACET, NODES]),
              ("facets, sides swapped", [FACET, *SWAP]), ("smooth, second order, 32 x 2", grid(32, 2, 2)),
              ("smooth, second order", grid(64, 4, 2)),
              ("smooth, second order, half the step", [*grid(64, 4, 2), *HALF]),
              ("smooth, second order, 128 x 8, half the step", [*grid(128, 8, 2), *HALF]))]
CASES += [("curved beams", f"smooth, {name}", SCENES / "curved_beams.yaml", own, beams)
          for name, own in (
              ("mu 0.3, node to surface", [NODES]), ("mu 0.3, half the step", HALF),
              ("mu 0.3, 128 x 8", grid(128, 8, 1)), ("mu 0.3, second order, 128 x 8", grid(128, 8, 2)),
              ("mu 0.29", ["contact.0.friction.mu=0.29"]),
              ("mu 0.3, gap 0.1 at the start", grid(64, 4, 1, 0.1)),
              ("mu 0.3, stiff stick", ["contact.0.friction.stick.penalty=2e4"]),
              ("mu 0.3, ten times the penalty", ["contact.0.penalty.scale=30"]),
              ("mu 0.3, hardening 420.5", [f"bodies.{k}.material.hardening.linear=420.5" for k in (0, 1)]),
              ("mu 0.3, full integration", [f"bodies.{k}.formulation=full" for k in (0, 1)]),
              ("mu 0.3, 48 x 4", grid(48, 4, 1)), ("mu 0.3, 48 x 4, gap 0.06 at the start", grid(48, 4, 1, 0.06)))]
FLAT = (8, 60, 1.06)  # elements along the radius and the length, ratio of neighbours; second order


def bar_mesh(nr, nl, progression, order=2, simplex=0):
    return [f"mesh.order={order}",
            f"mesh.parameters={{nr: {nr}, nl: {nl}, progression: {progression}, simplex: {simplex}}}"]


CASES += [("necking bar", f"{name}, {mesh[0]} x {mesh[1]}", SCENES / "necking.yaml",
           [f"stepping.dt_max={dt}", f"bodies.0.formulation={kind}", *bar_mesh(*mesh)], bar)
          for name, kind, mesh, dt in (
              ("full, second order", "full", FLAT, 0.0025),
              ("full, triangles of second order", "full", (*FLAT, 2, 1), 0.0025),
              ("enhanced, first order", "enhanced", (16, 120, 1.03, 1), 0.0025),
              ("mixed, second order", "mixed", (32, 80, 1.03), 0.0025),
              ("mixed, triangles of second order", "mixed", (24, 64, 1.04, 2, 1), 0.0025),
              ("fbar, first order", "fbar", (48, 144, 1.02, 1), 0.0025),
              ("mixed, first order", "mixed", (48, 144, 1.02, 1), 0.0025),
              ("full, second order, finer", "full", (16, 72, 1.06), 0.0025),
              ("full, second order, half the step", "full", FLAT, 0.00125))]
ROUND = ["supports=[{surface: symmetry_x, ux: 0}, {surface: symmetry_y, uy: 0}]", "geometry=plane_strain", "probes=[]",
         "loads=[{surface: inner, ux: \"0.02*cos(theta)\", uy: \"0.02*sin(theta)\"}]", "bodies.0.material.nu=0.4999"]
CASES += [("thick cylinder", f"{name}, order {order}", SCENES / "plastic_cylinder.yaml",
           [f"mesh.order={order}", f"bodies.0.formulation={name}",
            f"mesh.parameters={{form: 0, n_wall: {20 // order}, n_arc: {12 // order}, n_len: 1, len: 0.1}}", *ROUND],
           cylinder) for name, order in (("fbar", 1), ("enhanced", 1), ("mixed", 1), ("mixed", 2))]
CASES += [("pinched pipe", f"{name}, {smoother}", ROOT / "runs/pipe_pinch.yaml",
           [f"bodies.0.material={law}", f"bodies.1.material={ELASTIC}", f"contact.0.smoother={smoother}",
            "stepping={initial: 0.05}", "output.every=0"], pipe)
          for name, law in (("elastic", ELASTIC), ("steel that yields", STEEL)) for smoother in ("facet", "diffuse")]


def solve(case, args):
    name, variant, scene, overrides, figures = case
    directory = args.out / f"{name}-{variant}".replace(" ", "_").replace(",", "")
    shutil.rmtree(directory, ignore_errors=True)
    status = subprocess.run(command(args.burnish, 1, scene, directory, overrides, "-quiet"),
                            env=environment(args.burnish), stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL).returncode
    summary = read_summary(directory)
    counts = {"status": status, "steps": summary["steps"], "failed": summary["steps_failed"],
              "iterations": summary["newton_iterations"]}
    return [{"case": name, "variant": variant, "t": f"{t:.6g}", "quantity": quantity, "value": f"{value:.6g}",
             "reference": "" if reference is None else f"{reference:.6g}", "source": source, **counts}
            for t, quantity, value, reference, source in figures(read_steps(directory))]


def print_table(records):
    last = None
    for record in records:
        if (record["case"], record["variant"]) != last:
            last = record["case"], record["variant"]
            print(f"{record['case']}, {record['variant']}: {record['steps']} steps, {record['failed']} failed, "
                  f"{record['iterations']} iterations{'' if record['status'] == '0' else ', NOT to the end'}")
        error = (f"  {100 * (float(record['value']) / float(record['reference']) - 1):+.2f} % of {record['source']}"
                 if record["reference"] else "")
        print(f"    {record['quantity']} at t = {record['t']}: {record['value']}{error}")


def main():
    parser = table_parser(__doc__, "forming")
    parser.add_argument("--case", choices=sorted({case[0] for case in CASES}))
    parser.add_argument("--variant", default="")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    for name in dict.fromkeys(case[0] for case in CASES):
        if not args.only_print and args.case in (None, name):
            known = [row for row in read_records(args.record) if row["case"] == name] if args.variant else []
            rows = [row for case in CASES if case[0] == name
                    for row in (solve(case, args) if re.search(args.variant, case[1]) else
                                [row for row in known if row["variant"] == case[1]])]
            replace_records(args.record, COLUMNS, name, rows)
    print_table(read_records(args.record))


if __name__ == "__main__":
    main()

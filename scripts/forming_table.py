"""Metal forming: runs the scenes of forming that are in tests/scenes and runs, leaves steps, iterations and the forces,
places and angles that have a reference in a record, and prints the table; --print tables an existing record.
    python scripts/forming_table.py [--burnish BINARY] [--record FILE]"""
import math
import shutil
import subprocess

import numpy

from launch import ROOT, command, environment, read_records, read_steps, read_summary, table_parser, write_records

SCENES = ROOT / "tests/scenes"
COLUMNS = ("case", "variant", "t", "quantity", "value", "reference", "source", "status", "steps", "failed", "iterations")
E, NU, Y = 200e3, 0.3, 200  # of the ball
K, MODULUS = 0.454 + 0.41 * NU, E / (1 - NU**2)
W_C = (math.pi * K * 2.8 * Y / (2 * MODULUS))**2
P_C = 2 / 3 * K * 2.8 * Y * math.pi * W_C
STEEL = "{law: von_mises, E: 200e3, nu: 0.3, yield: 300, hardening: {linear: 1000}}"
ELASTIC = "{law: svk, E: 200e3, nu: 0.3}"
BEAMS = {3: (8.89, -7.55), 6: (13.37, -13.39), 9: (15.12, -17.56), 12: (16.00, -21.05), 15: (16.74, -24.33),
         18: (17.20, -28.23), 21: (16.72, -32.73), 24: (11.12, -38.77), 27: (-2.09, -26.51), 30: (-1.49, -5.72)}


def row_at(steps, t):
    at = int(numpy.argmin(numpy.abs(steps["t"] - t)))
    return {key: values[at] for key, values in steps.items()}


def ball(steps):
    for way in (2, 6, 10, 50):
        fit = 1.03 * way**1.425 if way <= 6 else 1.40 * way**1.263
        yield way / 110, f"P/P_c at {way} w_c", row_at(steps, way / 110)["force"] / P_C, fit, "Kogut and Etsion 2002"


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


def beams(steps):
    for u, force in BEAMS.items():
        for key, reference in zip(("force_x", "force_y"), force):
            if u <= 31.5 * steps["t"][-1]:
                yield u / 31.5, key, numpy.interp(u / 31.5, steps["t"], steps[key]), reference, "Neto et al. 2016"


def pipe(steps):
    yield 1, "plate_force", row_at(steps, 1)["plate_force"], None, ""


CASES = [("ball on a plane", name, SCENES / "sphere_flat.yaml", [f"mesh.parameters={mesh}"], ball)
         for name, mesh in (("h 3e-4", "{h: 3e-4, growth: 0.06}"), ("h 6e-4", "{h: 6e-4, growth: 0.12}"))]
CASES += [("ring between plates", name, SCENES / "ring_springback.yaml", ["stepping.at=[0.5]", *own], ring)
          for name, own in (("default steps", []), ("dt 0.02", ["stepping.dt_max=0.02"]))]
CASES += [("vee die", name, SCENES / "vee_bend.yaml", own, vee)
          for name, own in (("100 x 8, fbar", []), ("200 x 16, fbar", ["mesh.parameters.nx=200", "mesh.parameters.ny=16"]),
                            ("100 x 8, second order", ["mesh.order=2"]))]
CASES += [("upset billet", name, SCENES / "upset.yaml", own, billet)
          for name, own in (("default steps", []), *((f"plastic_strain {bound}", [f"stepping.plastic_strain={bound}"])
                                                     for bound in (0.5, 0.2, 0.1, 0.05, 0.01)))]
CASES += [("curved beams", f"{smoother}, mu {mu}", SCENES / "curved_beams.yaml",
           [f"contact.0.smoother={smoother}", f"contact.0.friction.mu={mu}"], beams)
          for mu in (0.3, 0) for smoother in ("diffuse", "facet")]
CASES += [("curved beams", "diffuse, mu 0.3, second order", SCENES / "curved_beams.yaml", ["mesh.order=2"], beams)]
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
    args = parser.parse_args()
    if not args.only_print:
        args.out.mkdir(parents=True, exist_ok=True)
        write_records(args.record, COLUMNS, lambda case: solve(case, args), CASES, 1)
    print_table(read_records(args.record))


if __name__ == "__main__":
    main()

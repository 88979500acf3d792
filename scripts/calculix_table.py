"""CPU seconds of Burnish over those of CalculiX at equal accuracy: twelve scenes, each with several meshes and numbers
of steps in either code, one after the other in one run. Of each code the table takes the cheapest setting whose answer
is within the bound of the scene's reference. Scenes that a code does not finish within it are listed and not counted.
    calculix_table.py [--burnish BINARY] [--ccx BINARY] [--repeats N] [--only SCENE ...] [--add]
                       [--record FILE] [--print]
Meshes, CalculiX's input and what both share are those of compare_calculix.py. A reference is a closed form, or the
answer of Burnish on a finer mesh, whose run is in the record, too. The part of CalculiX's time in its solver for
equations, SPOOLES, is that of the samples of `perf` in a further run of the chosen setting, where perf is there."""
import csv
import dataclasses
import shutil
import statistics
import subprocess
import sys

import compare_calculix
from compare_calculix import (AT_ONCE, ENHANCED, FIT_TORQUE, INPUTS, PIPE_WITH_FRICTION, REFERENCES, STICKS, SLIPS,
                              AbaqusMesh, Setting, ccx_cup, ccx_pipe, cup, fit, of_law, pipe, rubbing)
from launch import ROOT, environment, read_records, table_parser

COLUMNS = ("scene", "role", *compare_calculix.COLUMNS[1:], "spooles")
SURFACE = ("contact.0.smoother=diffuse", "contact.0.formulation=surface_to_surface")
THIN, OTHER = 0.1, 1 / 3  # targets of the ratio


@dataclasses.dataclass
class Scene:
    """Settings of both codes, the reference, and how far from it answers may be (%)."""
    target: float
    bound: float
    settings: list
    reference: object  # a number, or a setting of Burnish


def steps(n):
    """Of the pipe: so many equal ones."""
    return AT_ONCE if n == 1 else (f"stepping.initial={1 / n}", "stepping.at=[]")


def pipes(change, ways=((), ), walls=(1, ), counts=(1, 4), calculix_counts=(1, 4)):
    """The pipe with friction or another law: change() is applied to each setting."""
    found = [change(ccx_pipe("C3D8I", 36, wall, 6, 1, 1 / n)) for wall in walls for n in calculix_counts]
    for way in ways:
        name = "surface to surface, " if way else ""
        found += [change(pipe(f"enhanced, {name}{n} steps", 36, wall, 6, 1, *steps(n), *way)) for wall in walls
                  for n in counts]
    return found


def rubs(setting):
    return rubbing(dataclasses.replace(setting, name=f"mu 0.3, {setting.name}"), 0.3)


def yields(setting):
    return of_law(setting, "yields")


def yielding_pipes():
    """Two elements through the wall: with one both codes are 9 % off. CalculiX has first-order bricks alone; its
    second-order ones have no nodes where those of Burnish have."""
    found = [ccx_pipe("C3D8I", n_arc, 2, n_len, 1, 1 / 20) for n_arc, n_len in ((16, 4), (24, 4), (36, 6))]
    found += [pipe(f"enhanced, {n} steps", 16, 2, 4, 1, *steps(n)) for n in (4, 10, 20)]
    found += [pipe("enhanced, 20 steps", 36, 2, 6, 1, *steps(20))]
    found += [pipe(f"second order, {n} steps", n_arc, 2, n_len, 1, *steps(n), order=2)
              for n_arc, n_len, n in ((8, 2, 4), (8, 4, 4), (12, 4, 4))]
    return [yields(setting) for setting in found]


def fine_pipe(n_arc, n_wall, n_len, n):
    return pipe(f"second order, {n} steps", n_arc, n_wall, n_len, 1, *steps(n), order=2)


def finer(setting):
    """On a mesh twice as fine, where the start of the programs counts less."""
    parameters = {key: 2 * value for key, value in setting.parameters.items()}
    name = setting.name.replace("120x3", "240x6").replace("120 on 120", "240 on 240")
    return dataclasses.replace(setting, name=name, parameters=parameters)


def ring(code, n, increment=0, nu=0.49):
    mesh = {"n": n, "triangles": 0}
    law = f"bodies.0.material={{law: isochoric_neo_hookean, E: 5.5, nu: {nu}}}"
    name = f"CAX8R, {round(1 / increment)} steps" if increment else "mixed quad9, own steps"
    return Setting("o_ring", code, f"nu {nu}, {name}, n {n}", 2, mesh, (law, ), element="CAX8R", scale=200, nu=nu,
                   increment=increment or 1)


def ironing(code, refine, increment=0):
    laws = [f"bodies.{k}.material={{law: isochoric_neo_hookean, E: {young}, nu: {nu}}}"
            for k, (young, nu) in enumerate(compare_calculix.IRONING.values())]
    name = f"CPE8, {round(1 / increment)} steps" if increment else "second order, own steps"
    return Setting("ironing", code, f"{name}, refined {refine}", 2, {"refine": refine}, tuple(laws), element="CPE8",
                      increment=increment or 1, scale=20)


def necking(code, nr, nl, n, order=2):
    mesh = {"nr": nr, "nl": nl, "progression": 1.06 if order == 2 else 1.03, "simplex": 0}
    element = "CAX8R" if order == 2 else "CAX4"
    overrides = (f"loads.0.uy={compare_calculix.NECKING_WAY}", f"stepping.dt_max={1 / n}")
    name = element if code == "calculix" else "second order" if order == 2 else "enhanced"
    if code == "burnish" and order == 1:
        overrides = (*overrides, "bodies.0.formulation=enhanced")
    return Setting("necking", code, f"{name}, {n} steps, {nr}x{nl}", order, mesh, overrides, element=element,
                   increment=1 / n)


def fits(turn):
    return [dataclasses.replace(fit(code, turn), name=f"{fit(code, turn).name.replace('10 steps', f'{n} steps')}",
                                increment=1 / n,
                                overrides=(*fit(code, turn).overrides, f"stepping.initial={1 / n}"))
            for code in ("calculix", "burnish") for n in (1, 2, 10)]


def fine_fit(turn):
    mesh = {"n_inner": 240, "n_outer": 240, "n_wall": 12}
    return dataclasses.replace(fit("burnish", turn), name="fine, 20 steps", parameters=mesh,
                               overrides=(*fit("burnish", turn).overrides, "stepping.initial=0.05"))


SCENES = {
    "pipe": Scene(THIN, 1, pipes(lambda setting: setting), REFERENCES["pipe_pinch"]),
    "pipe, friction 0.3": Scene(THIN, 1, pipes(rubs, ((), SURFACE)), rubs(fine_pipe(36, 1, 12, 4))),
    "pipe that yields": Scene(THIN, 2.5, yielding_pipes(), yields(fine_pipe(24, 2, 10, 20))),
    "cup": Scene(THIN, 0.2, [
        *(ccx_cup(1 / n, scale=1) for n in (1, 4, 10)), ccx_cup(1),
        cup("enhanced, steps by contact", 1, 120, 3, *ENHANCED),
        cup("enhanced, one step", 1, 120, 3, *ENHANCED, "stepping.control=fixed", "stepping.initial=1")
    ], REFERENCES["cup_flattening"]),
    "cup, finer": Scene(THIN, 0.2, [
        *(finer(ccx_cup(1 / n, scale=1)) for n in (1, 4)),
        finer(cup("enhanced, one step", 1, 120, 3, *ENHANCED, "stepping.control=fixed", "stepping.initial=1"))
    ], REFERENCES["cup_flattening"]),
    "O-ring": Scene(OTHER, 1, [
        *(ring("calculix", n, 0.2) for n in (4, 8)), *(ring("burnish", n) for n in (4, 8))
    ], ring("burnish", 24)),
    "O-ring, nu 0.499": Scene(OTHER, 1, [ring("calculix", 8, 0.1, 0.499), ring("burnish", 8, 0, 0.499)],
                              ring("burnish", 24, 0, 0.499)),
    "ironing": Scene(OTHER, 1, [
        *(ironing("calculix", 1, 1 / n) for n in (20, 40)), ironing("burnish", 0.5), ironing("burnish", 1)
    ], ironing("burnish", 2)),
    "necking bar": Scene(OTHER, 1, [
        *(necking(code, 4, 30, n) for code in ("calculix", "burnish") for n in (25, 50, 100))
    ], necking("burnish", 8, 60, 400)),
    "shrink fit, sticks": Scene(OTHER, 1, fits(STICKS), fine_fit(STICKS)),
    "shrink fit, sticks, finer": Scene(OTHER, 1, [
        finer(setting) for setting in fits(STICKS) if "10 steps" not in setting.name
    ], fine_fit(STICKS)),
    "shrink fit, slips": Scene(OTHER, 1, fits(SLIPS), FIT_TORQUE),
}


def spooles(args, setting, directory):
    """Part of the samples of a run of CalculiX that are in SPOOLES and the BLAS."""
    if not shutil.which("perf"):
        return None
    samples = directory / "perf.data"
    subprocess.run(["perf", "record", "-q", "-F", "99", "-o", samples, args.ccx, "-i", "case"], cwd=directory,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment(args.burnish))
    report = subprocess.run(["perf", "report", "-i", samples, "--sort", "dso", "--stdio", "-q"], capture_output=True,
                            text=True).stdout
    parts = [line.split() for line in report.splitlines() if "%" in line]
    return sum(float(part[0].rstrip("%")) for part in parts
               if any(name in part[-1] for name in ("spooles", "blas"))) / 100


def solve(args, name, setting, role, repeat):
    row = compare_calculix.record(args, setting, repeat)
    if role == "spooles" and setting.code == "calculix":
        row["spooles"] = spooles(args, setting, args.out / "run")
    row.update(scene=name, role=role, error=None)
    print(f"{name}: {setting.code} {setting.name}: {row['cpu_s']:.2f} s, {row.get('iterations')} iterations, "
          f"{row['status']}, {row['force']}", file=sys.stderr, flush=True)
    return row


def reference(name, rows):
    """The reference of a scene, or None where its run is not in the record."""
    if not isinstance(SCENES[name].reference, Setting):
        return SCENES[name].reference
    found = [row for row in rows if row["scene"] == name and row["role"] == "reference" and row["force"]]
    return float(found[0]["force"]) if found else None


def chosen(name, code, rows):
    """The cheapest setting of a code whose answer is within the bound, as (rows, CPU seconds, error); else None."""
    exact, best = reference(name, rows), None
    rows = [row for row in rows if row["scene"] == name and row["code"] == code and row["role"] == "timed"]
    for setting in dict.fromkeys(row["setting"] for row in rows):
        runs = [row for row in rows if row["setting"] == setting]
        if exact is None or any(not row["force"] for row in runs):
            continue
        error = 100 * (float(runs[0]["force"]) / exact - 1)
        cpu = statistics.median(float(row["cpu_s"]) for row in runs)
        if abs(error) <= SCENES[name].bound and (best is None or cpu < best[1]):
            best = runs, cpu, error
    return best


def taken(args, rows):
    """Cases of the settings of CalculiX that the table takes."""
    best = {name: chosen(name, "calculix", rows) for name in args.only}
    return [(name, setting, "spooles", 0) for name in args.only for setting in SCENES[name].settings
            if best[name] and setting.code == "calculix" and setting.name == best[name][0][0]["setting"]]


def measure(args):
    """All runs: first the references, then all settings in turn, and one more of those of CalculiX that are taken."""
    rows = []
    kept = [row for row in read_records(args.record) if row["scene"] not in args.only] if args.add else []
    cases = [(name, SCENES[name].reference, "reference", 0) for name in args.only
             if isinstance(SCENES[name].reference, Setting)]
    cases += [(name, setting, "timed", repeat) for repeat in range(args.repeats) for name in args.only
              for setting in SCENES[name].settings]
    with open(args.record, "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(kept)
        while cases:
            row = solve(args, *cases.pop(0))
            rows.append({key: "" if value is None else value for key, value in row.items()})
            writer.writerow(row)
            file.flush()
            if not cases and row["role"] != "spooles":
                cases = taken(args, rows)


def print_table(rows):
    print("| scene | code | setting | steps (failed) | iterations | CPU s | answer | error, % | ratio | target | |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    for name, scene in SCENES.items():
        if not any(row["scene"] == name for row in rows):
            continue
        best = {code: chosen(name, code, rows) for code in ("calculix", "burnish")}
        for code, found in best.items():
            label = "CalculiX" if code == "calculix" else "Burnish"
            head = f"| {f'{name}, to {scene.bound:g} %' if code == 'calculix' else ''} | {label} |"
            if not found:
                tried = [row for row in rows if row["scene"] == name and row["code"] == code and row["role"] == "timed"]
                done = sum(1 for row in tried if row["force"])
                print(f"{head} none of {len(tried)} runs, {done} of which ended | | | | | | | | not counted |")
                continue
            runs, cpu, error = found
            share = [float(row["spooles"]) for row in rows if row["scene"] == name and row["spooles"]]
            equations = f" ({share[0]:.0%} SPOOLES)" if share and code == "calculix" else ""
            end = "| | | |"
            if code == "burnish" and best["calculix"]:
                ratio = cpu / best["calculix"][1]
                end = f"| {ratio:.2g} | {scene.target:.2g} | {'held' if ratio <= scene.target else 'missed'} |"
            first = runs[0]
            print(f"{head} {first['setting']} | {first['steps']} ({first['steps_failed']}) | "
                  f"{first['iterations']} | {cpu:.2f}{equations} | {float(first['force']):.5g} | {error:+.2f} {end}")


def main():
    parser = table_parser(__doc__, "calculix_ratios")
    parser.add_argument("--ccx", default="ccx")
    parser.add_argument("--repeats", type=int, default=2)
    parser.add_argument("--limit", type=int, default=600, help="CPU seconds of a run of CalculiX or Burnish")
    parser.add_argument("--only", nargs="+", choices=SCENES, default=list(SCENES), metavar="SCENE")
    parser.add_argument("--add", action="store_true", help="keep the rows of other scenes that are in the record")
    args = parser.parse_args()
    args.launcher = []
    if not args.only_print:
        if not shutil.which(args.ccx):
            sys.exit(f"{args.ccx}: CalculiX is not there: apt-get install calculix-ccx")
        args.burnish, args.out = args.burnish.resolve(), args.out.resolve()
        args.out.mkdir(parents=True, exist_ok=True)
        measure(args)
    print_table(read_records(args.record))


if __name__ == "__main__":
    main()

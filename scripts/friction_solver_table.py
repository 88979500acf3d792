"""What friction costs the solver, and how even the forces of a sliding die are: iterations and failed steps of the
paper's scenes with friction and without, and forces of a die that is drawn over a block in long and short steps. Both ways to
measure the gap, the smooth master and its facets; cheap scenes on several ranks, too. Leaves one record per run and
prints the tables; --print tables an existing record.
    python scripts/friction_solver_table.py [--burnish BINARY] [--record FILE] [--print] [CASE ...]
A case that is named replaces its rows in the record. Iterations are those of all steps, iterations_per_step those of
the die while it slides. V and H are means after the first 30 % of its way, and a swing is from peak to peak without the
trend, in per cent of the mean."""
import shutil
import subprocess

import numpy

from launch import ROOT, command, environment, read_records, read_steps, read_summary, replace_records, table_parser

COLUMNS = ("case", "mu", "step", "formulation", "smoother", "ranks", "status", "iterations", "iterations_per_step",
           "failed", "V", "H", "swing_V", "swing_H")
SURFACE, NODE = "surface_to_surface", "node_to_surface"
WAYS = ((SURFACE, "diffuse"), (NODE, "diffuse"), (SURFACE, "facet"), (NODE, "facet"))
SHORT = {SURFACE: "surface", NODE: "nodes", "diffuse": "smooth", "facet": "facets"}
SCENES = {"pipe_pinch": (1, ), "plate_cylinder": (1, ), "cup_flattening": (1, 2, 3)}  # on so many ranks
PRESS, SLIDE = 3, 9  # of the die: steps in which it is pressed, faces by which it is drawn
DIE = ROOT / "tests/scenes/die.yaml"
DIE_RANKS, DIE_CHEAP = (1, 2, 3), 0.5  # steps at least so long run on all of these


def die_steps(step):
    """How many steps of so many faces the slide takes, and when it starts."""
    steps = round(SLIDE / step)
    return steps, PRESS / (PRESS + steps)


def die_overrides(mu, step, formulation, smoother):
    """Offsets are live on the smooth master where there are any; facets have held ones."""
    steps, start = die_steps(step)
    live = smoother == "diffuse" and formulation == SURFACE
    return [
        f"loads.0.history=[[0, 0], [{start}, 1], [1, 1]]", f"loads.1.history=[[0, 0], [{start}, 0], [1, 1]]",
        f"stepping={{control: fixed, initial: {1 / (PRESS + steps)}, at: [{start}]}}", f"contact.0.friction.mu={mu}",
        f"contact.0.formulation={formulation}", f"contact.0.smoother={smoother}",
        f"contact.0.offset={'live' if live else 'held'}"
    ]


def die_figures(steps, step):
    """Means of V and H, their swings, and iterations per step of the slide. steps: columns of steps.csv."""
    t, start = numpy.array(steps["t"]), die_steps(step)[1]
    along = t > start + 0.3 * (1 - start)
    forces = numpy.array([-numpy.array(steps["force_y"])[along], numpy.array(steps["force_x"])[along]])
    place = numpy.arange(along.sum())
    trend = numpy.array([numpy.polyval(numpy.polyfit(place, force, 1), place) for force in forces])
    swing = 100 * numpy.ptp(forces - trend, axis=1) / forces.mean(axis=1)
    return forces.mean(axis=1), swing, numpy.mean(numpy.array(steps["newton"])[t > start * (1 + 1e-9)])


def scene_cases(scene):
    for ranks in SCENES[scene]:
        for way in WAYS:
            for mu in (0, 0.2, 0.5):
                yield mu, "", way, ranks


def die_cases():
    for mu in (0.3, 0.8):
        for way in WAYS:
            for step in (3, 1, 0.5, 0.2) if way[1] == "diffuse" else (0.2, ):
                for ranks in DIE_RANKS if step >= DIE_CHEAP else (1, ):
                    yield mu, step, way, ranks


def solve(args, case, mu, step, way, ranks):
    """The record of one run."""
    directory = args.out / f"{case}_{mu}_{step}_{way[0]}_{way[1]}_{ranks}"
    overrides = die_overrides(mu, step, *way) if case == "die" else [
        f"contact.0.friction.mu={mu}", f"contact.0.formulation={way[0]}", f"contact.0.smoother={way[1]}"
    ]
    shutil.rmtree(directory, ignore_errors=True)
    line = command(args.burnish, ranks, DIE if case == "die" else ROOT / f"runs/{case}.yaml", directory,
                   [*overrides, "output.every=0"], "-quiet")
    finished = subprocess.run(line, env=environment(args.burnish), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True)
    record = dict(zip(COLUMNS, (case, mu, step, *way, ranks, finished.returncode)))
    if finished.returncode:
        print(" ".join(str(word) for word in line), finished.stdout[-500:], sep="\n")
        return record
    steps, summary = read_steps(directory), read_summary(directory)
    shutil.rmtree(directory, ignore_errors=True)
    record.update(iterations=int(sum(steps["newton"])), failed=summary["steps_failed"])
    if case == "die":
        forces, swing, per_step = die_figures(steps, step)
        record.update(iterations_per_step=f"{per_step:.2f}", V=f"{forces[0]:.10g}", H=f"{forces[1]:.10g}",
                      swing_V=f"{swing[0]:.3f}", swing_H=f"{swing[1]:.3f}")
    return record


def apart(rows, columns):
    """Largest difference between rank counts, relative to one rank."""
    one = next(row for row in rows if row["ranks"] == "1")
    if any(row["status"] != "0" for row in rows):
        return "-"
    return f"{max(abs(float(row[name]) / float(one[name]) - 1) for row in rows for name in columns):.1g}"


def groups(records, names):
    """Records by what they have in these columns, in the order of the file."""
    found = {}
    for row in records:
        found.setdefault(tuple(row[name] for name in names), []).append(row)
    return found


def print_die(records):
    print("| gap | master | mu | step (faces) | iterations a step | failed | V | H | swing of V, H (per cent) | "
          "ranks apart |\n|" + " --- |" * 10)
    for key, rows in groups(records, ("formulation", "smoother", "mu", "step")).items():
        row = next(row for row in rows if row["ranks"] == "1")
        figures = "not converged | - | - | - | -" if row["status"] != "0" else (
            f"{row['iterations_per_step']} | {row['failed']} | {float(row['V']):.4f} | {float(row['H']):.4f} | "
            f"{row['swing_V']}, {row['swing_H']}")
        print(f"| {SHORT[key[0]]} | {SHORT[key[1]]} | {key[2]} | {key[3]} | {figures} | "
              f"{apart(rows, ('V', 'H')) if len(rows) > 1 else '-'} |")


def iterations(row):
    if row["status"] != "0":
        return "not converged"
    return row["iterations"] + (f" ({row['failed']} failed)" if row["failed"] != "0" else "")


def print_scenes(records):
    print("\n| scene | gap | master | ranks | iterations, mu 0 | mu 0.2 | mu 0.5 |\n|" + " --- |" * 7)
    for key, rows in groups(records, ("case", "formulation", "smoother", "ranks")).items():
        print(f"| `runs/{key[0]}.yaml` | {SHORT[key[1]]} | {SHORT[key[2]]} | {key[3]} | "
              f"{' | '.join(iterations(row) for row in rows)} |")


def main():
    cases = [*SCENES, "die"]
    parser = table_parser(__doc__, "friction_solver")
    parser.add_argument("cases", nargs="*", metavar="CASE", choices=[[], *cases], default=[])
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    for case in [] if args.only_print else args.cases or cases:
        runs = die_cases() if case == "die" else scene_cases(case)
        replace_records(args.record, COLUMNS, case, [solve(args, case, *run) for run in runs])
    records = read_records(args.record)
    print_die([row for row in records if row["case"] == "die"])
    print_scenes([row for row in records if row["case"] != "die"])


if __name__ == "__main__":
    main()

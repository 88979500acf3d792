"""CalculiX's own contact decks, taken over by `burnish -import`, beside CalculiX (ccx, Debian's package calculix-ccx):
runs both, compares displacements and contact forces at the end, leaves a record and prints the table; --print tables an
existing record. The decks are those of Debian's package calculix-ccx-test.
    python scripts/deck_table.py [--decks FOLDER] [--deck NAME] [--burnish BINARY] [--ccx ccx] [--record FILE]
Where bricks of 20 nodes or quadrilaterals of 8 were completed, the elements differ, and the reference is CalculiX on a
mesh that is once refined. `displacement` is the largest difference of a displacement component at any node of the deck,
`force` that of the contact force on a body, in per cent of the largest one. Forces of the reference are the sums of the
outer forces on a body."""
import gzip
import pathlib
import re
import shutil
import subprocess

import h5py
import numpy

from deckrefinement import refined
from launch import ROOT, command, environment, read_records, read_summary, table_parser, write_records
from meshfiles.deck import Deck, resolve
from meshfiles.deckscene import DeckScene
from meshfiles.mesh import MeshError

FOLDER = "/usr/share/doc/calculix-ccx-test/examples/test"
COLUMNS = ("deck", "elements", "comparison", "status", "steps", "iterations", "displacement", "force", "remarks")
COMPARISONS = ("same mesh", "both refined", "CalculiX refined", "CalculiX, both meshes")
ROUNDING = 1e-6  # of all forces: sums below it are those of rounding
LARGEST = 5000  # elements of decks that are refined
WEDGE = 180  # CalculiX expands axisymmetric elements to wedges of 2 degrees
NEAR = 1e-5  # of the size of the model: nodes at one place


def bodies(deck):
    """Number of the body, connected by elements, of each node of the deck."""
    parent = {}

    def root(node):
        while parent.setdefault(node, node) != node:
            parent[node] = node = parent[parent[node]]
        return node

    for _, nodes in deck.whole.elements.values():
        for node in nodes[1:]:
            parent[root(node)] = root(nodes[0])
    roots = {}
    return {node: roots.setdefault(root(node), len(roots)) for node in list(parent)}


def body_of_surface(deck, name, body):
    """The body on which a surface of the deck is."""
    part = deck.whole
    kind, lines = next(value for key, value in part.surfaces.items() if key.upper() == name.upper())
    number = int(lines[0][0]) if lines[0][0].isdigit() else resolve(
        part.nsets if kind == "NODE" else part.elsets, lines[0][0], name)[0]
    return body[number if kind == "NODE" else part.elements[number][1][0]]


def read_frd(path):
    """Places, displacements and outer forces at the nodes, of the last state in a file of CalculiX."""
    tables, table = {"NODE": {}}, None
    with open(path, errors="replace") as file:
        for line in file:
            if line.startswith("    2C"):
                table = tables["NODE"]
            elif line.startswith(" -4"):
                table = tables[line[5:13].strip()] = {}
            elif line.startswith(" -3"):
                table = None
            elif line.startswith(" -1") and table is not None:
                values = [float(line[k:k + 12]) for k in range(13, len(line.rstrip()) - 11, 12)]
                table[int(line[3:13])] = values[:3]
    return tables["NODE"], tables.get("DISP", {}), tables.get("FORC", {})


def solve_reference(text, plane, folder, args):
    """CalculiX's last state of a deck, None where it gives none."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    wanted = "*NODE FILE" + (", OUTPUT=2D" if plane else "") + "\nU, RF\n"
    (folder / "deck.inp").write_text(re.sub(r"(?im)^\*end *step", wanted + r"\g<0>", text))
    with open(folder / "ccx.txt", "w") as log:
        try:
            subprocess.run([args.ccx, "deck"], cwd=folder, stdout=log, stderr=subprocess.STDOUT, timeout=args.limit,
                           env=environment(args.burnish))
        except subprocess.TimeoutExpired:
            return None
        except FileNotFoundError:
            raise SystemExit(f"there is no {args.ccx}; Debian's package calculix-ccx has it") from None
    said = (folder / "ccx.txt").read_text(errors="replace")
    if "*ERROR" in said or "Job finished" not in said or not (folder / "deck.frd").exists():
        return None
    return read_frd(folder / "deck.frd")


def deviation(places, values, directory, dim):
    """Largest difference of displacement components over the largest one. Of several nodes at one place the one that
    is nearest in its displacement counts."""
    with h5py.File(directory / "results.h5", "r") as file:
        nodes = file["mesh/nodes"][()]
        ours = file["steps"][sorted(file["steps"])[-1]]["displacement"][()]
    near = NEAR * numpy.ptp(nodes, axis=0).max()
    largest = most = 0.0
    for number, value in values.items():
        there = numpy.flatnonzero((numpy.abs(nodes - places[number]) < near).all(axis=1))
        if len(there):
            largest = max(largest, numpy.abs(value[:dim]).max())
            most = max(most, numpy.abs(ours[there, :dim] - value[:dim]).max(axis=1).min())
    return most / largest


def force_deviation(deck, scene, forces, probes):
    """Largest difference of the contact force on a body over the largest one; None where each pair is on one body, and
    where the forces of contact cancel each other, as those of a ring on a shaft."""
    body = bodies(deck)
    n = max(body.values()) + 1
    axes = [1] if scene.axisymmetric else range(scene.dim)
    ours, theirs = numpy.zeros((n, 3)), numpy.zeros((n, 3))
    apart = False
    for k, (slave, master, _) in enumerate(scene.pairs):
        force = [sum(probes.get(f"{kind}_{k + 1}_{axis}") or 0.0 for kind in ("contact", "friction"))
                 for axis in "xyz"]
        on = body_of_surface(deck, master, body), body_of_surface(deck, slave, body)
        ours[on[0]] += force
        ours[on[1]] -= force
        apart = apart or on[0] != on[1]
    for number, force in forces.items():
        if number in body:
            theirs[body[number]] -= force
    theirs *= WEDGE if scene.axisymmetric else 1
    largest = numpy.linalg.norm(theirs[:, axes], axis=1).max()
    everywhere = sum(numpy.linalg.norm(force) for force in forces.values())
    if not apart or largest <= ROUNDING * everywhere:
        return None
    return numpy.linalg.norm((ours - theirs)[:, axes], axis=1).max() / largest


def import_and_run(file, folder, args):
    """Takes a deck over and runs it: the deck, its scene, the folder of the run and what to record of it."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    try:
        deck = Deck(file)
        scene = DeckScene(deck)
        (folder / "scene.yaml").write_text(scene.text("scene.msh"))
        scene.mesh.write(folder / "scene.msh")
    except MeshError as error:
        return None, None, {"status": "refused", "remarks": str(error).replace(f"{file.parent}/", "")}
    said = [line for line in scene.remarks() if not line.startswith("note:")]
    record = {"elements": " ".join(sorted(deck.whole.types)),
              "remarks": "; ".join(said).replace(f"{file.parent}/", "")}
    line = command(args.burnish, 1, folder / "scene.yaml", folder / "run", args.set, "-quiet")[3:]
    try:
        finished = subprocess.run(line, env=environment(args.burnish), stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True, timeout=args.limit)
    except subprocess.TimeoutExpired:
        return deck, scene, {**record, "status": "too long"}
    if finished.returncode:
        print(file.stem, finished.stdout.strip()[:1500], flush=True)
        return deck, scene, {**record, "status": f"exit {finished.returncode}"}
    summary = read_summary(folder / "run")
    return deck, scene, {**record, "status": "done", "steps": summary["steps"],
                         "iterations": summary["newton_iterations"]}


def compared(deck, scene, folder, numbers, found):
    """Deviations of a run from a state of CalculiX at the nodes of the deck with these numbers."""
    places, displacements, forces = found
    values = {number: value for number, value in displacements.items() if number in numbers}
    force = force_deviation(deck, scene, forces, read_summary(folder / "run")["probes"])
    return {"displacement": f"{100 * deviation(places, values, folder / 'run', scene.dim):.3g}",
            "force": "" if force is None else f"{100 * force:.3g}"}


def solve(name, args):
    """The records of one deck: on its own mesh, and where that can be made, on the refined one."""
    file, folder = args.decks / f"{name}.inp", args.out / name
    deck, scene, record = import_and_run(file, folder / "deck", args)
    record = {"deck": name, "comparison": "same mesh", **record}
    if record["status"] != "done" or "missing:" in record["remarks"]:  # another problem has another answer
        return [record]
    plane, numbers = scene.dim == 2, set(deck.whole.nodes)
    own = solve_reference(file.read_text(errors="replace"), plane, folder / "ccx", args)
    if own is None:
        return [{**record, "comparison": "none: CalculiX fails"}]
    records = [{**record, **compared(deck, scene, folder / "deck", numbers, own)}]
    text = refined(deck) if len(deck.whole.elements) <= LARGEST else None
    if text is None:
        return records
    (folder / "refined.inp").write_text(text)
    fine = solve_reference(text, plane, folder / "ccx_refined", args)
    if fine is None:
        return records
    largest = max(max(map(abs, own[1][number])) for number in own[1])
    itself = max(max(abs(a - b) for a, b in zip(own[1][number], fine[1][number])) for number in own[1])
    fine_deck, fine_scene, fine_record = import_and_run(folder / "refined.inp", folder / "refined", args)
    records += [{"deck": name, "comparison": "CalculiX, both meshes", "displacement": f"{100 * itself / largest:.3g}"},
                {"deck": name, "comparison": "CalculiX refined",
                 **compared(fine_deck, scene, folder / "deck", numbers, fine)}]
    if fine_record["status"] == "done":
        records.append({"deck": name, "comparison": "both refined", "steps": fine_record["steps"],
                        "iterations": fine_record["iterations"], "status": "done",
                        **compared(fine_deck, fine_scene, folder / "refined", numbers, fine)})
    return records


def unpacked(folder, out):
    """The folder, or a copy of its decks where some are packed, as Debian packs large files of documentation."""
    packed = sorted(folder.glob("*.inp.gz"))
    if not packed:
        return folder
    out.mkdir(parents=True, exist_ok=True)
    for file in folder.glob("*.inp"):
        shutil.copy(file, out)
    for file in packed:
        (out / file.stem).write_bytes(gzip.decompress(file.read_bytes()))
    return out


def contact_decks(folder):
    """Names of the decks that have contact."""
    return [file.stem for file in sorted(folder.glob("*.inp"))
            if re.search(r"(?im)^\*contact pair", file.read_text(errors="replace"))]


def figures(rows, deck, comparison):
    """Both deviations of a comparison, as a text."""
    for row in rows:
        if (row["deck"], row["comparison"]) == (deck, comparison):
            return " / ".join(row[key] or "–" for key in ("displacement", "force"))
    return "–"


def print_table(rows):
    print("| deck | elements | " + ", % | ".join(COMPARISONS) + ", % | steps, iterations |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    first = {}
    for row in rows:
        first.setdefault(row["deck"], row)
    for deck, row in first.items():
        if row["status"] == "done" and "missing:" not in row["remarks"]:
            print(f"| `{deck}` | {row['elements']} | " + " | ".join(figures(rows, deck, c) for c in COMPARISONS) +
                  f" | {row['steps']}, {row['iterations']} |")
    said = {}  # decks by what is said of them
    for deck, row in first.items():
        if row["remarks"] or row["status"] != "done" or row["comparison"] != "same mesh":
            said.setdefault(summary_of(row), []).append(f"`{deck}`")
    print("\n| deck | not taken, or in another way |\n| --- | --- |")
    for text, decks in said.items():
        print(f"| {', '.join(decks)} | {text} |")


def summary_of(row):
    """The remarks on a deck, without the lines of the file, and with the cards that are not available in one list."""
    cards = re.findall(r"missing: \S+: (\*[A-Z -]+): not available", row["remarks"])
    others = [re.sub(r"\S+\.inp:\d+: ", "", text).replace("changed: ", "").replace("missing: ", "not taken: ")
              for text in row["remarks"].split("; ") if text and not text.endswith(": not available")]
    if row["status"] == "refused":
        others = ["refused: " + row["remarks"]]
    parts = [row["comparison"]] if row["comparison"] != "same mesh" else []
    parts += ["not available: " + ", ".join(f"`{card}`" for card in dict.fromkeys(cards))] if cards else []
    parts += [f"ends with {row['status'].replace('exit', 'exit status')}"] if row["status"].startswith("exit") else []
    return "; ".join(parts + list(dict.fromkeys(others)))


def main():
    parser = table_parser(__doc__, "decks")
    parser.add_argument("--decks", type=pathlib.Path, default=pathlib.Path(FOLDER), help="folder with the decks")
    parser.add_argument("--deck", action="append", help="only this one; can be repeated")
    parser.add_argument("--ccx", default="ccx")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="of the scenes, as for burnish")
    parser.add_argument("--limit", type=float, default=600, help="seconds for one run of either program")
    args = parser.parse_args()
    args.burnish, args.out = args.burnish.resolve(), args.out.resolve()
    if not args.only_print:
        args.decks = unpacked(args.decks, args.out / "decks")
        names = args.deck or contact_decks(args.decks)
        if not names:
            raise SystemExit(f"no deck with *CONTACT PAIR in {args.decks}; allowed: a folder with decks, such as that "
                             "of Debian's package calculix-ccx-test")
        args.out.mkdir(parents=True, exist_ok=True)
        write_records(args.record, COLUMNS, lambda name: solve(name, args), names, 1)
    print_table(read_records(args.record))


if __name__ == "__main__":
    main()

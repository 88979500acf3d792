#!/usr/bin/env python3
"""Checks that the folders of src stand in the order of src/LAYERS.

usage: layers.py OBJECTS [SRC [INCLUDE]]

OBJECTS is the folder of the object files, laid out as src. The test lists
  - every call (by the symbols of the objects) and every #include from a lower folder to a higher one,
  - every #include of a header in another folder's private/,
  - every circle of source files (by calls) and of headers (by includes),
  - every #include of a header of src in a public header,
  - every folder that is not in src/LAYERS.
It exits with 1 if there is any.
"""
import collections
import pathlib
import re
import subprocess
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def symbols(objects):
    """Global symbols that each object file defines, and those that it wants; nm reads all files in one call."""
    text = subprocess.run(["nm", "-A", *map(str, objects)], capture_output=True, text=True, check=True).stdout
    found = {path: (set(), set()) for path in objects}
    by_name = {str(path): path for path in objects}
    for line in text.splitlines():
        name, _, rest = line.partition(":")
        *_, kind, symbol = rest.split()
        if kind == "U" or kind in "TDRBVWC":
            found[by_name[name]][kind == "U"].add(symbol)
    return found


def circles(graph):
    """Strongly connected sets of more than one node, by Tarjan's algorithm."""
    index, low, stack, on_stack, found = {}, {}, [], set(), []

    def visit(v):
        index[v] = low[v] = len(index)
        stack.append(v)
        on_stack.add(v)
        for w in graph[v]:
            if w not in index:
                visit(w)
                low[v] = min(low[v], low[w])
            elif w in on_stack:
                low[v] = min(low[v], index[w])
        if low[v] == index[v]:
            ring = []
            while not ring or ring[-1] != v:
                ring.append(stack.pop())
                on_stack.discard(ring[-1])
            if len(ring) > 1:
                found.append(sorted(ring))

    sys.setrecursionlimit(10000)
    for v in list(graph):
        if v not in index:
            visit(v)
    return found


class Layers:
    def __init__(self, objects, src, public):
        self.objects, self.src, self.public = map(pathlib.Path, (objects, src, public))
        lines = [line.split("#")[0].strip() for line in (self.src / "LAYERS").read_text().splitlines()]
        self.floor = {name: i for i, name in enumerate(filter(None, lines))}
        self.wrong = set()

    def folder(self, path):
        return path.parts[0] if len(path.parts) > 1 else "."

    def runs_up(self, lower, higher):
        """main.c stands above all folders."""
        return self.floor.get(self.folder(higher), 99) > self.floor.get(self.folder(lower), 99)

    def check_calls(self):
        found = sorted(self.objects.rglob("*.o"))
        units = {o.relative_to(self.objects).with_suffix(""): names for o, names in symbols(found).items()}
        units = {u: s for u, s in units.items() if (self.src / u).with_suffix(".c").exists()}  # no leftovers of builds
        owner = {symbol: u for u, (defined, _) in units.items() for symbol in defined}
        graph = collections.defaultdict(set, {u: set() for u in units})
        for u, (_, wanted) in units.items():
            if self.folder(u) != "." and self.folder(u) not in self.floor:
                self.wrong.add(f"not in LAYERS: {u}")
            for symbol in wanted & owner.keys():
                if owner[symbol] == u:
                    continue
                graph[u].add(owner[symbol])
                if self.runs_up(u, owner[symbol]):
                    self.wrong.add(f"call up: {u}.c -> {owner[symbol]}.c ({symbol})")
        for ring in circles(graph):
            self.wrong.add("circle: " + " ".join(map(str, ring)))
        return len(units)

    def target(self, path, name):
        """The header of src that an #include in a file of src means, or None."""
        folder = self.src / self.folder(path.relative_to(self.src))
        for place in (folder / "private" / name, self.src / name, path.parent / name):
            if place.is_file():
                return place.resolve().relative_to(self.src.resolve())
        return None

    def check_includes(self):
        graph = collections.defaultdict(set)
        for path in sorted([*self.src.rglob("*.c"), *self.src.rglob("*.h")]):
            me = path.relative_to(self.src)
            for name in INCLUDE.findall(path.read_text()):
                header = self.target(path, name)
                if not header:
                    if not (self.public / name).is_file():
                        self.wrong.add(f"no such header: {me} -> {name}")
                    continue
                if self.runs_up(me, header):
                    self.wrong.add(f"include up: {me} -> {header}")
                if "private" in header.parts and self.folder(header) != self.folder(me):
                    self.wrong.add(f"private header: {me} -> {header}")
                if path.suffix == ".h":
                    graph[me].add(header)
                    graph.setdefault(header, set())
        for ring in circles(graph):
            self.wrong.add("circle of headers: " + " ".join(map(str, ring)))

    def check_public(self):
        names = {h.name for h in self.src.rglob("*.h")}
        for header in self.public.rglob("*.h") if self.public.is_dir() else []:
            for name in INCLUDE.findall(header.read_text()):
                if pathlib.PurePath(name).name in names:
                    self.wrong.add(f"public header: {header.name} -> {name}")


def main(objects, src=None, public=None):
    root = pathlib.Path(__file__).resolve().parent.parent
    layers = Layers(objects, src or root / "src", public or root / "include")
    n_units = layers.check_calls()
    layers.check_includes()
    layers.check_public()
    if not n_units:
        layers.wrong.add(f"no objects in {objects}")
    print("\n".join(sorted(layers.wrong)) or
          f"{n_units} files in {len(layers.floor)} folders: every dependency runs down, no circle")
    return 1 if layers.wrong else 0


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3, 4):
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))

"""What ranks have to exchange, from the parts of a mesh alone: the messages and rows of the matrices on all levels of
multigrid, and how the work is shared. The parts are those of a run (tests/bench/partition.c -write); multigrid is
imitated by aggregates on the graph of the nodes. Nothing is run and nothing is fitted here."""
import numpy
from scipy import sparse
from scipy.spatial import cKDTree

SEED = 1
FINE_ROWS, COARSE_ROWS = 3, 6  # of a node; of an aggregate: rigid motions
LEAST_ROWS = 50  # of an active rank on a coarse level: PETSc's -pc_gamg_process_eq_limit
SQUARED = 1  # levels whose aggregates are those of the squared graph: PETSc's aggressive coarsening
# Part of the interface coupled to other ranks from which on parts overlap by two rows (src/linear/multigrid.c)
SMALL = 0.5
COARSEST_ROWS = 50  # no level follows one with fewer: PETSc's -pc_gamg_coarse_eq_limit


def pattern(rows, columns, shape):
    """A matrix of ones."""
    matrix = sparse.csr_matrix((numpy.ones(len(rows), dtype=numpy.int32), (rows, columns)), shape=shape)
    matrix.data[:] = 1
    return matrix


def product(*factors):
    """The pattern of a product."""
    result = factors[0]
    for factor in factors[1:]:
        result = (result @ factor).tocsr()
        result.data[:] = 1
    return result


def incidence(lists, n):
    """Of lists of nodes, one a row."""
    lists = numpy.asarray(lists)
    return pattern(numpy.repeat(numpy.arange(len(lists)), lists.shape[1]), lists.ravel(), (len(lists), n))


class Mesh:
    """What tests/bench/partition.c has written to a folder. support: master nodes to which a slave node is coupled."""

    def __init__(self, folder, support):
        self.cells = numpy.loadtxt(folder / "cells.txt", dtype=int)
        nodes = numpy.loadtxt(folder / "nodes.txt")
        self.n = len(nodes)
        slave, master = (numpy.loadtxt(folder / f"{name}.txt", dtype=int) for name in ("slave", "master"))
        self.slaves = numpy.unique(slave)
        self.contact = numpy.isin(self.cells, numpy.concatenate((slave.ravel(), master.ravel()))).sum(axis=1) > 2
        elastic = product(incidence(self.cells, self.n).T.tocsr(), incidence(self.cells, self.n))
        masters = numpy.unique(master)
        _, near = cKDTree(nodes[masters]).query(nodes[self.slaves], support)
        terms = incidence(numpy.column_stack((self.slaves, masters[near])), self.n)
        self.coupled = product(terms.T.tocsr(), terms)
        self.graph = elastic + self.coupled
        self.graph.data[:] = 1
        with open(folder / "parts.txt") as file:
            lines = (line.split(maxsplit=1) for line in file)
            self.parts = {int(p): numpy.fromstring(rest, dtype=int, sep=" ") for p, rest in lines}
        self.levels = list(coarsen(self.graph))

    def owners(self, ranks):
        """The rank of each node: the last one that has a cell of it."""
        owner = numpy.full(self.n, -1)
        numpy.maximum.at(owner, self.cells, self.parts[ranks][:, None])
        return owner


def aggregate(graph, squared):
    """Roots of aggregates that cover the graph, and the aggregate of each node."""
    near = product(graph, graph) if squared else graph
    state, order = numpy.full(graph.shape[0], -1), numpy.random.default_rng(SEED).permutation(graph.shape[0])
    roots = []
    for node in order:
        if state[node] < 0:
            ball = near.indices[near.indptr[node]:near.indptr[node + 1]]
            state[ball[state[ball] < 0]] = len(roots)
            roots.append(node)
    return numpy.array(roots), state


def coarsen(graph):
    """(roots, prolongation, graph) of each coarse level."""
    level = 0
    while graph.shape[0] * (COARSE_ROWS if level else FINE_ROWS) > COARSEST_ROWS:
        roots, state = aggregate(graph, level < SQUARED)
        if len(roots) == graph.shape[0]:
            return
        smooth = product(graph, pattern(numpy.arange(len(state)), state, (len(state), len(roots))))
        graph = product(smooth.T.tocsr(), graph, smooth)
        yield roots, smooth, graph
        level += 1


def active(ranks, rows):
    """Ranks that have rows on a coarse level: PETSc takes the divisor that is nearest to the number it wants."""
    wanted = min(ranks, max(1, int(rows / LEAST_ROWS + 0.5)))
    return max((d for d in range(1, ranks + 1) if ranks % d == 0), key=lambda d: min(d / wanted, wanted / d))


def exchange(matrix, row_owner, column_owner, ranks):
    """(messages, rows of nodes) that each rank sends for a product: mean and largest."""
    coo = matrix.tocoo()
    mine, other = row_owner[coo.row], column_owner[coo.col]
    cut = mine != other
    ghosts = numpy.unique(mine[cut] * matrix.shape[1] + coo.col[cut])
    pairs = numpy.unique(mine[cut] * ranks + other[cut])
    messages = numpy.bincount(pairs % ranks, minlength=ranks)
    rows = numpy.bincount(column_owner[ghosts % matrix.shape[1]], minlength=ranks)
    return messages.mean(), messages.max(), rows.mean(), rows.max()


def across(mesh, owner):
    """Part of the nodes of the interface that contact couples to other ranks."""
    coo = mesh.coupled.tocoo()
    return len(numpy.unique(coo.row[owner[coo.row] != owner[coo.col]])) / len(numpy.unique(coo.row))


def colours(graph, owner, ranks):
    """Of the ranks, as src/linear/sweeporder.c finds them."""
    coo = graph.tocoo()
    pairs = pattern(owner[coo.row], owner[coo.col], (ranks, ranks))
    colour = numpy.full(ranks, -1)
    for rank in range(ranks):
        near = pairs.indices[pairs.indptr[rank]:pairs.indptr[rank + 1]]
        taken = set(colour[near[near < rank]])
        colour[rank] = min(set(range(len(taken) + 1)) - taken)
    return colour


def turns(graph, owner, ranks):
    """Colours; the part of a rank's nodes that has turns, and that is at its border; and messages in which their values
    and those of the other nodes at borders go to all neighbours once: means over the ranks."""
    coo, colour = graph.tocoo(), colours(graph, owner, ranks)
    mine, other = owner[coo.row], owner[coo.col]
    lower, higher = (numpy.zeros(graph.shape[0], dtype=bool) for _ in range(2))
    lower[coo.row[colour[other] < colour[mine]]] = True
    higher[coo.row[colour[other] > colour[mine]]] = True
    cut, late = mine != other, (lower & higher)[coo.col]
    sent = [len(numpy.unique(mine[kind] * ranks + other[kind])) / ranks for kind in (cut & ~late, cut & late)]
    return {"colours": colour.max() + 1, "turn": (lower & higher).mean(), "border": (lower | higher).mean(),
            "early_messages": sent[0], "turn_messages": sent[1]}


def costs(mesh, ranks):
    """Features of a number of ranks."""
    owner = mesh.owners(ranks)
    cells = numpy.bincount(mesh.parts[ranks], minlength=ranks)
    slaves = numpy.bincount(owner[mesh.slaves], minlength=ranks)
    contact = numpy.bincount(mesh.parts[ranks][mesh.contact], minlength=ranks)
    found = {"cells": cells.max() / cells.mean(), "slaves": slaves.max() / slaves.mean(),
             "contact": contact.max() / contact.mean()}
    put = lambda name, values: found.update({f"{name}_{k}": v for k, v in
                                             zip(("messages", "most", "rows", "most_rows"), values)})
    put("fine", exchange(mesh.graph, owner, owner, ranks))
    found["own_interface"] = len(numpy.unique(mesh.coupled.indices)) / ranks
    found.update(turns(mesh.graph, owner, ranks))
    found["across"] = across(mesh, owner)
    reach = product(mesh.coupled, mesh.coupled) if found["across"] > SMALL else mesh.coupled
    put("reach", exchange(reach, owner, owner, ranks))
    for k, (roots, smooth, graph) in enumerate(mesh.levels, 1):
        on = active(ranks, COARSE_ROWS * len(roots))
        above, owner = owner, owner[roots] // (ranks // on) * (ranks // on) if on < ranks else owner[roots]
        put(f"level{k}", exchange(graph, owner, owner, ranks))
        put(f"transfer{k}", exchange(smooth, above, owner, ranks))
    return found

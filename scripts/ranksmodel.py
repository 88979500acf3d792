"""The model of scripts/ranks_table.py. What an iteration exchanges is a multiple of what the parts of the mesh have to
exchange (scripts/rankscosts.py); the factors are fitted on few ranks. How long it then takes follows from the seconds
of one rank and from a network that is stated."""
import math

import numpy
from scipy.optimize import nnls

DOUBLE = 8  # bytes
FINE, COARSE = 3, 6  # rows of a node; of an aggregate
# An iteration smooths the finest level with four sweeps both ways, in which early values and those of turns go to each
# neighbour once; two of them begin with values of the step before, one with those of a guess, and once there is a
# residual
SWEEPS, SHARES = 4, 3
PRODUCTS = 4  # of a coarse level; its values are restricted and prolonged besides
HALVES = 8  # sweeps one way
LEVELS = 8  # at most
# The network: seconds of a message, bytes a second of a rank (200 Gbit/s for 64 ranks)
LATENCY, BANDWIDTH = 2e-6, 4e8
COARSENING = 10  # nodes of a level for one of the next
WEAK = 30000  # unknowns of a rank where the mesh grows with the ranks


def levels(part, what):
    return sum(PRODUCTS * part.get(f"level{k}_{what}", 0) + 2 * part.get(f"transfer{k}_{what}", 0)
               for k in range(1, LEVELS))


def neighbours(part):
    """Of the coarse levels together."""
    return sum(part.get(f"level{k}_messages", 0) for k in range(1, LEVELS))


def sweeps(part):
    return SWEEPS * (part["early_messages"] + part["turn_messages"]) + (SHARES - 1) * part["fine_messages"]


def messages(part):
    """Sweeps and the residual of the finest level, coarse levels; the product of the outer method, the interface."""
    return sweeps(part) + 3 * part["fine_messages"] + levels(part, "messages") + part["reach_messages"]


def most_messages(part):
    return messages(part) * part["fine_most"] / part["fine_messages"]


# What each quantity is a sum of, with factors to be fitted: name -> terms of the parts
TERMS = {
    "messages": lambda p: [messages(p)],
    "most_messages": lambda p: [most_messages(p)],
    "bytes": lambda p: [DOUBLE * FINE * (SWEEPS + SHARES + 2) * p["fine_rows"],
                        DOUBLE * (COARSE * levels(p, "rows") + FINE * p["reach_rows"])],
    "most_bytes": lambda p: [DOUBLE * FINE * (SWEEPS + SHARES + 2) * p["fine_most_rows"],
                             DOUBLE * (COARSE * levels(p, "most_rows") + FINE * p["reach_most_rows"])],
    "reductions": lambda p: [1],
    "newton_messages": lambda p: [p["fine_messages"] + p["reach_messages"] + neighbours(p)],
    "newton_bytes": lambda p: [DOUBLE * FINE * p["fine_rows"], DOUBLE * FINE * p["reach_rows"]],
    "newton_reductions": lambda p: [1],
    "imbalance_cells": lambda p: [p["cells"]],
    "imbalance_contact": lambda p: [p["contact"]],
    "slave_points": lambda p: [p["slaves"]],
    "fits": lambda p: [p["slaves"]],
}


def numbers(row):
    return {name: float(value) for name, value in row.items() if value not in ("", None)
            and name not in ("program", "status")}


def fit(name, runs, parts):
    """Factors of the terms, none negative, by relative deviations."""
    terms = numpy.array([TERMS[name](part) for part in parts])
    values = numpy.array([run[name] for run in runs])
    return nnls(terms / values[:, None], numpy.ones(len(values)))[0]


def predict(name, factors, part):
    return float(numpy.dot(factors[name], TERMS[name](part)))


def waiting(part, before=False):
    """What a rank waits in half a sweep for its turn, in parts of the work of the half sweep. before: all nodes of the
    border had turns, and every second colour swept its other nodes last."""
    if before:
        border = part["border"]
        return (1 - border) * (part["colours"] > 2) + (part["colours"] - 1) * border - border * (part["colours"] > 1)
    return max(0, (part["colours"] - 1) * part["turn"] - (1 - part["turn"]))


def scaled(part, factor):
    """The features where the mesh has `factor` times the nodes: neighbours stay, surfaces grow less than volumes."""
    grown = {name: value * factor**(2 / 3) if name.endswith("_rows") else value for name, value in part.items()}
    for name, power in (("nodes", 1), ("own_interface", 2 / 3), ("turn", -2 / 3), ("border", -1 / 3)):
        if name in part:
            grown[name] = part[name] * factor**power  # turns are at the edges of parts
    return grown


def repeated(part, times):
    """The features where there are so many times the ranks, with parts of the same size: each has the same to do, and
    multigrid has more levels, whose ranks all have neighbours."""
    grown = {**part, "nodes": part["nodes"] * times}
    there = [k for k in range(1, LEVELS) if part.get(f"level{k}_messages")]
    for k in range(round(math.log(times, COARSENING))):
        grown[f"level{there[-1] + 1 + k}_messages"] = max(part[f"level{j}_messages"] for j in there)
    return grown


def alone(part, ranks):
    """What one rank needs of a mesh that has these features on several ranks."""
    return {"nodes": part["nodes"], "own_interface": part["own_interface"] * ranks}


def rates(run):
    """CPU seconds from the run on one rank, whose wall time others have shared."""
    share = run["cpu_s"] / run["wall_s"]
    iteration = run["krylov_s"] * share / run["applied"]
    newton = (run["steps_s"] - run["krylov_s"]) * share / run["tangents"]
    part = {"interface": run["interface_s"] / run["krylov_s"], "sweep": run["sweep_s"] / run["krylov_s"]}
    contact = run["contact_s"] / (run["steps_s"] - run["krylov_s"])
    return {"iteration": iteration * (1 - part["interface"]) / run["dofs"],
            "sweep": iteration * part["sweep"] / run["dofs"], "interface": iteration * part["interface"],
            "newton": newton * (1 - contact) / run["dofs"], "contact": newton * contact,
            "serial": run["setup_s"] * share / run["dofs"], "iterations": run["applied"],
            "tangents": run["tangents"]}


def seconds(part, ranks, factors, rate, interface):
    """Seconds of a run by cause. part: features on these ranks, of a mesh of so many nodes; None: one rank. interface:
    nodes of the interface of the run from which the rates are."""
    dofs = FINE * part["nodes"]
    own = part["own_interface"] * ranks / interface
    found = {"first rank alone": rate["serial"] * dofs}
    if ranks == 1:
        found["work"] = (rate["iterations"] * (rate["iteration"] * dofs + rate["interface"] * own) +
                         rate["tangents"] * (rate["newton"] * dofs + rate["contact"] * own))
        return found
    each = dofs / ranks
    found["work"] = rate["iterations"] * rate["iteration"] * each + rate["tangents"] * (
        rate["newton"] * each + rate["contact"] * own / ranks) + rate["iterations"] * rate["interface"] * own / ranks
    found["shares of unequal size"] = (part["cells"] - 1) * each * (
        rate["iterations"] * rate["iteration"] + rate["tangents"] * rate["newton"]) + (
            part["slaves"] - 1) * rate["tangents"] * rate["contact"] * own / ranks
    found["overlap of the interface"] = rate["iterations"] * rate["interface"] * part["reach_most_rows"] / interface
    found["turns of sweeps"] = rate["iterations"] * (rate["sweep"] * each * waiting(part) +
                                                     HALVES * (part["colours"] - 1) * LATENCY)
    found["messages"] = LATENCY * (rate["iterations"] * predict("most_messages", factors, part) +
                                   rate["tangents"] * predict("newton_messages", factors, part))
    found["bytes"] = (rate["iterations"] * predict("most_bytes", factors, part) +
                      rate["tangents"] * predict("newton_bytes", factors, part)) / BANDWIDTH
    found["reductions"] = LATENCY * math.log2(ranks) * (
        rate["iterations"] * predict("reductions", factors, part) +
        rate["tangents"] * predict("newton_reductions", factors, part))
    return found

"""The model of scripts/ranks_table.py: what an iteration exchanges, as multiples of what the parts of the mesh have to
exchange, and how long it then takes on a network that is stated. Factors are fitted on few ranks."""
import math

import numpy
from scipy.optimize import nnls

DOUBLE = 8  # bytes
FINE, COARSE = 3, 6  # rows of a node; of an aggregate
SWEEPS = 7  # exchanges of the finest level: of two smoothers of two sweeps, with their residuals, and of the residual
TURNS = 4  # products of a coarse level
LEVELS = 8


def numbers(row):
    return {name: float(value) for name, value in row.items() if value not in ("", None) and name not in (
        "program", "status")}


def levels(part, what):
    return sum(part.get(f"level{k}_{what}", 0) * TURNS + 2 * part.get(f"transfer{k}_{what}", 0)
               for k in range(1, LEVELS))


# What each quantity is a sum of, with factors to be fitted: name -> terms of the parts
TERMS = {
    "sweep_messages": lambda p: [6 * p["fine_messages"]],
    "messages": lambda p: [SWEEPS * p["fine_messages"] + levels(p, "messages"),
                           2 * p["fine_messages"] + p["reach_messages"]],
    "most_messages": lambda p: [SWEEPS * p["fine_most"] + levels(p, "most"), 2 * p["fine_most"] + p["reach_most"]],
    "bytes": lambda p: [DOUBLE * FINE * (SWEEPS + 2) * p["fine_rows"],
                        DOUBLE * (COARSE * levels(p, "rows") + FINE * p["reach_rows"])],
    "most_bytes": lambda p: [DOUBLE * FINE * (SWEEPS + 2) * p["fine_most_rows"],
                             DOUBLE * (COARSE * levels(p, "most_rows") + FINE * p["reach_most_rows"])],
    "newton_messages": lambda p: [p["fine_messages"] + p["reach_messages"], levels(p, "messages")],
    "newton_bytes": lambda p: [DOUBLE * FINE * p["fine_rows"], DOUBLE * FINE * p["reach_rows"]],
    "reductions": lambda p: [1],
    "newton_reductions": lambda p: [1],
    "imbalance_cells": lambda p: [p["cells"]],
    "imbalance_contact": lambda p: [p["contact"]],
    "slave_points": lambda p: [p["slaves"]],
    "fits": lambda p: [p["slaves"]],
}


def fit(name, runs, parts):
    """Factors of the terms, none negative, by relative deviations."""
    terms = numpy.array([TERMS[name](part) for part in parts])
    values = numpy.array([run[name] for run in runs])
    return nnls(terms / values[:, None], numpy.ones(len(values)))[0]


def predict(name, factors, part):
    return float(numpy.dot(factors, TERMS[name](part)))

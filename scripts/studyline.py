"""What the rows of a study show without its options: the numbers of their labels, the rows that no other row beats,
what an error costs along a line, and from where on a line gains nothing. For study.py and studyplot.py.

A row is a dictionary with its errors by the name of the measure (per cent), its values and its CPU seconds; a line is a
list of rows, usually from a coarse mesh to a fine one."""

import math

# Nothing is extrapolated beyond this many times the CPU seconds of a line's last point.
FAR = 100
# A value of the axis buys nothing from which on it changes the result by less than the error that stays over this.
DOMINATES = 10


def number(text):
    try:
        return float(text)
    except ValueError:
        return math.nan


def front(rows, measure):
    """Those than which none is both cheaper and more accurate."""
    points = sorted(
        (row for row in rows if row["errors"].get(measure)), key=lambda row: (row["cpu_s"], row["errors"][measure])
    )
    return [
        row
        for k, row in enumerate(points)
        if all(row["errors"][measure] < other["errors"][measure] for other in points[:k])
    ]


def cost(series, measure, target):
    """CPU seconds from which on a line stays below an error: (seconds, how). how is "" where they are interpolated in
    log-log, "<=" where the first point is below, ">" where the error is not reached at the last point, "~" where they
    are extrapolated by the slope of the last two points, and None where no run has an error.
    """
    points = [(row["cpu_s"], row["errors"][measure]) for row in series if row["errors"].get(measure)]
    above = [k for k, (_, error) in enumerate(points) if error > target]
    if not above or len(points) == 1:
        return (points[0][0], ">" if above else "<=") if points else (None, None)
    first = min(above[-1], len(points) - 2)
    (x0, e0), (x1, e1) = points[first : first + 2]
    beyond = math.log(e1 / e0) and math.log(x1 / x0) * math.log(target / e1) / math.log(
        e1 / e0
    )  # from x1 on, in natural logarithms
    if above[-1] == first < len(points) - 1 and e1 <= target:
        return x1 * math.exp(beyond), ""
    return (x1 * math.exp(beyond), "~") if e1 < e0 and x1 > x0 and beyond < math.log(FAR) else (x1, ">")


def enough(series, measure):
    """(row, error): the first row of a line after which the value changes by less than a DOMINATES-th of the error that
    stays. row is None where there is no such row."""
    there = [row for row in series if row["errors"].get(measure)]
    if not there:
        return None, None
    last, error = there[-1]["values"][measure], there[-1]["errors"][measure]
    near = [100 * abs(row["values"][measure] / last - 1) <= error / DOMINATES for row in there]
    return next((row for k, row in enumerate(there[:-1]) if all(near[k:])), None), error

# SPDX-License-Identifier: BSD-3-Clause
"""What all plots share. Figures are made without pyplot: no window system, no global state."""
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

TRUTH, ESTIMATE, FORWARD_KINEMATICS = "#222222", "#c8442c", "#2a6fbb"
STATE_COLOURS = {"TRACKING": "#3f8f4f", "OCCLUDED": "#e0a030", "LOST": "#c8442c", "INITIALIZING": "#2a6fbb",
                 "UNINITIALIZED": "#999999"}
LINES = ["#2a6fbb", "#d1662a", "#3f8f4f", "#8856a7", "#b58900", "#17919b", "#c2185b", "#666666"]


def new_figure(rows, columns, width, height, **options):
    """(figure, axes as matplotlib's subplots gives them), size in inches."""
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    axes = figure.subplots(rows, columns, **options)
    for one in (axes.ravel() if hasattr(axes, "ravel") else [axes]):
        one.grid(True, color="#dddddd", linewidth=0.6)
        one.set_axisbelow(True)
        for side in ("top", "right"):
            one.spines[side].set_visible(False)
    return figure, axes


def log_axis(axis, fine=False):
    """Logarithmic with plain numbers: 0.1, 1, 10. @param fine: also 0.2, 0.5, ..., for an axis over few decades."""
    axis.axes.set_xscale("log") if axis.axis_name == "x" else axis.axes.set_yscale("log")
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if fine else (1.0,)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def save(figure, path, dpi=90):
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=dpi, bbox_inches="tight")
    return path


def shade_hidden(axes, times, hidden):
    """Grey where the object is out of sight."""
    start = None
    for k, out_of_sight in enumerate(list(hidden) + [False]):
        if out_of_sight and start is None:
            start = k
        elif not out_of_sight and start is not None:
            axes.axvspan(times[start], times[min(k, len(times) - 1)], color="#eeeeee", zorder=0)
            start = None

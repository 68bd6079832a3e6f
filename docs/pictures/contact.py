"""Picture of the contact, its symbols and its force curve, for the front pages.

python docs/pictures/contact.py        # writes docs/_static/contact-{wide,narrow}-{light,dark}.png

Every line is computed by `fscm`: both cross-sections are states of the force curve beside them.  Each file states the
named points and the checksum of this script, so that a test finds a file that is out of date.
"""

import hashlib
import io
import json
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from PIL import Image
from PIL.PngImagePlugin import PngInfo

import fscm

#: The contact drawn: a paraboloid on a half-space whose modulus grows with depth; soft enough to jump at a fold.
PROBLEM = fscm.Problem(n=2, k=0.4, mu=2.0)

#: Events of the force curve: letter, name, where their text stands relative to the point (points of text).
EVENTS = {
    "jump_in": ("A", "jump-in", (9, -3), "left"),
    "jump_out": ("B", "jump-out", (-7, -13), "right"),
    "pull_off": ("C", "pull-off, load $P_c$", (13, -5), "left"),
    "zero_load": ("D", "zero load", (-9, 7), "right"),
}

#: Half width, top and bottom of a cross-section, in units of radii and of z0.
_HALF, _TOP, _BOTTOM = 6.2, 10.2, -9.0

_WIDE = (("before", "curve"), ("contact", "law"))
_NARROW = (("before",), ("contact",), ("curve",), ("law",))
#: Layouts: panels by rows, and size in inches, of which 100 pixels are one on a page.
LAYOUTS: dict[str, tuple[Any, tuple[float, float]]] = {"wide": (_WIDE, (8.3, 6.9)), "narrow": (_NARROW, (3.7, 13.4))}


@dataclass(frozen=True)
class Theme:
    """Colours of a variant."""

    page: str
    text: str
    punch: str
    soft: str
    stiff: str
    modulus: str
    path: str
    approach: str
    retreat: str


THEMES = {
    "light": Theme("#ffffff", "#1f2328", "#b8bec6", "#dcecf8", "#5b9bd0", "#9a3b00", "#8c959f", "#0060a8", "#c04d00"),
    "dark": Theme("#0d1117", "#e6edf3", "#6b7480", "#1c3a55", "#2f6ea6", "#ffb27a", "#7d8590", "#63b3f5", "#ff9a57"),
}


@cache
def state(event: str) -> fscm.RadialField:
    """The surface at an event, which every variant shows."""
    return fscm.profile(PROBLEM, event, "quick")


def points(path: fscm.EquilibriumPath) -> dict[str, tuple[float, float]]:
    """Displacement and load of each event.

    The jumps are folds of the displacement, pull-off is the least load, and the zero of the load in contact is a point
    of the path.
    """
    jump_in = next(fold for fold in path.folds if fold.quantity == "displacement" and fold.maximum)
    jump_out = next(fold for fold in path.folds if fold.quantity == "displacement" and not fold.maximum)
    least = int(np.argmin(path.load))
    zero = int(np.flatnonzero(path.load[least:] >= -1e-9)[0]) + least
    return {
        "jump_in": (jump_in.displacement, jump_in.load),
        "jump_out": (jump_out.displacement, jump_out.load),
        "pull_off": (float(path.displacement[least]), float(path.load[least])),
        "zero_load": (float(path.displacement[zero]), float(path.load[zero])),
    }


def mirrored(field: fscm.RadialField) -> tuple[Any, Any, Any]:
    """Radius from left to right, height of the half-space, height of the punch."""
    inside = field.radius < 1.3 * _HALF
    radius, surface = field.radius[inside], -field.deformation[inside]
    face = surface + field.gap[inside]
    return tuple(np.concatenate([sign * line[::-1], line]) for sign, line in ((-1, radius), (1, surface), (1, face)))


def arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float], theme: Theme, style: str = "<->") -> None:
    """A dimension line."""
    shape = {"arrowstyle": style, "color": theme.text, "lw": 1.1, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 9}
    axes.annotate("", end, start, arrowprops=shape)


def bodies(axes: Axes, field: fscm.RadialField, theme: Theme, title: str) -> None:
    """Punch and half-space, which is the darker the larger its modulus is."""
    radius, surface, face = mirrored(field)
    depth = np.linspace(-3.6 / -_BOTTOM, 1.0, 256)[:, None].clip(0.0) ** PROBLEM.k
    colours = LinearSegmentedColormap.from_list("modulus", [theme.soft, theme.stiff])
    image = axes.imshow(depth, extent=(-_HALF, _HALF, _BOTTOM, 3.6), cmap=colours, aspect="auto", zorder=0)
    body = axes.fill_between(radius, surface, _BOTTOM, color="none")
    image.set_clip_path(body.get_paths()[0], axes.transData)
    axes.fill_between(radius, face, _TOP + 2.0, color=theme.punch, lw=0)
    axes.plot(radius, surface, color=theme.text, lw=0.8)
    axes.plot(radius, face, color=theme.text, lw=0.8)
    axes.axhline(0.0, color=theme.text, lw=0.7, ls=(0, (6, 4)))
    axes.plot([0, 0], [_BOTTOM, _TOP], color=theme.text, lw=0.5, ls=(0, (8, 3, 1, 3)))
    axes.set(xlim=(-_HALF, _HALF), ylim=(_BOTTOM, _TOP))
    axes.set_title(title)
    axes.axis("off")


def before_contact(axes: Axes, theme: Theme) -> None:
    """The last state before the jump into contact, with the gap and the modulus over the depth."""
    field = state("jump_in")
    bodies(axes, field, theme, "Before contact, at A")
    tip, low = -field.displacement, -float(field.deformation[0])
    axes.plot([-3.2, 2.5], [tip, tip], color=theme.text, lw=0.6)
    arrow(axes, (-2.9, 0.0), (-2.9, tip), theme, "->")
    axes.text(-3.35, 0.55 * tip, "displacement\n" r"$\delta < 0$", ha="right", size=9)
    axes.plot([0, 2.5], [low, low], color=theme.text, lw=0.6)
    arrow(axes, (2.2, low - 2.0), (2.2, low), theme, "->")
    arrow(axes, (2.2, tip + 2.0), (2.2, tip), theme, "->")
    axes.text(2.6, 0.5 * (low + tip) - 0.35, "central gap $H_0$", size=9)
    axes.text(0.0, 6.9, "punch\n$f(r) = r^n/(n\\,Q)$", ha="center", size=9, bbox=_behind(theme.punch))
    modulus_over_depth(axes, theme)


def modulus_over_depth(axes: Axes, theme: Theme) -> None:
    """The modulus over the depth, drawn into the half-space."""
    depth = np.linspace(0.0, -_BOTTOM - 0.6, 100)
    left = -5.7
    axes.plot(left + 1.7 * depth**PROBLEM.k, -depth - 0.15, color=theme.modulus, lw=1.6)
    arrow(axes, (left, 0.0), (left, _BOTTOM + 0.3), theme, "->")
    axes.text(left + 0.2, _BOTTOM + 0.55, "$z$", size=9)
    axes.text(0.4, -4.6, r"modulus $E(z) = E_0\,(z/c_0)^k$", color=theme.modulus, size=9)
    axes.text(0.4, -7.3, "or constant, layered,\ncoated, measured", color=theme.modulus, size=8.5)


def in_contact(axes: Axes, theme: Theme) -> None:
    """The state in contact without load, with displacement, contact radius and the signs."""
    field = state("zero_load")
    bodies(axes, field, theme, "In contact, at D")
    edge = float(field.radius[np.argmin(field.pressure)])
    tip = -field.displacement
    rim = float(np.interp(edge, field.radius, -field.deformation))
    axes.plot([-3.2, 0], [tip, tip], color=theme.text, lw=0.6)
    arrow(axes, (-2.9, 0.0), (-2.9, tip), theme, "->")
    axes.text(-3.35, 0.85 * tip, "displacement\n" r"$\delta > 0$", ha="right", size=9)
    axes.plot([edge, edge], [rim, -7.2], color=theme.text, lw=0.6)
    arrow(axes, (0.0, -6.9), (edge, -6.9), theme)
    axes.text(0.5 * edge, -8.4, "contact radius $a$", ha="center", size=9)
    axes.text(-5.9, -8.4, "half-space", size=9)
    arrow(axes, (0.0, _TOP - 0.1), (0.0, 3.6), theme, "-|>")
    axes.text(0.3, 6.6, "load $P$\n$> 0$ pushes\n$< 0$ pulls", size=9, va="center")


def _behind(colour: str) -> dict[str, Any]:
    return {"facecolor": colour, "edgecolor": "none", "pad": 1.5}


def force_curve(axes: Axes, path: fscm.EquilibriumPath, theme: Theme) -> None:
    """Load over displacement with the events, and what a machine that prescribes the displacement records."""
    cycle = fscm.displacement_cycle(path)
    axes.plot(path.displacement, path.load, color=theme.path, lw=1.2, label="all equilibria")
    axes.plot(*cycle.loading, color=theme.approach, lw=1.8, label="approach")
    axes.plot(*cycle.unloading, color=theme.retreat, lw=1.8, ls=(0, (4, 2)), label="retreat")
    axes.axhline(0.0, color=theme.text, lw=0.6)
    for event, (displacement, load) in points(path).items():
        letter, name, offset, side = EVENTS[event]
        axes.plot(displacement, load, "o", ms=5, color=theme.text, zorder=5)
        axes.annotate(
            f"$\\bf{{{letter}}}$  {name}", (displacement, load), offset, textcoords="offset points", ha=side, size=9
        )
    axes.set(
        xlim=(-7.2, 6.2),
        xticks=range(-6, 7, 2),
        ylim=(-2.2, 1.35),
        xlabel=r"displacement $\delta/z_0$   ($-$ away, $+$ into the solid)",
        ylabel=r"load $P/(\pi R\,\Delta\gamma)$",
        title="Force curve",
    )
    axes.legend(loc="upper left", frameon=False, fontsize=8.5)


def surface_law(axes: Axes, theme: Theme) -> None:
    """Traction of two flat surfaces over their distance."""
    distance = np.linspace(0.9, 4.2, 400)
    traction = PROBLEM.law.traction(distance - 1.0)
    axes.plot(distance, traction, color=theme.text, lw=1.6)
    tensile = distance >= 1.0
    axes.fill_between(distance[tensile], traction[tensile], color=theme.retreat, alpha=0.35, lw=0)
    axes.axhline(0.0, color=theme.text, lw=0.6)
    axes.axvline(1.0, color=theme.text, lw=0.6, ls=(0, (6, 4)))
    axes.annotate(
        "$z_0$: the surfaces\nneither attract\nnor repel, $H = 0$", (1.0, 0.0), (1.45, 0.42), size=9, va="center"
    )
    arrow(axes, (1.42, 0.3), (1.02, 0.03), theme, "->")
    axes.annotate(r"area: work of adhesion $\Delta\gamma$", (1.45, -0.5), (1.75, -0.85), size=9)
    arrow(axes, (1.9, -0.74), (1.45, -0.42), theme, "->")
    axes.set(
        xlim=(0.0, 4.2),
        ylim=(-1.2, 0.95),
        yticks=[-1.0, -0.5, 0.0, 0.5],
        xlabel="distance of the surfaces / $z_0$  ($= 1 + H/z_0$)",
        ylabel=r"pressure $p\,z_0/\Delta\gamma$",
        title="Surface law",
    )


def draw(layout: str, theme: Theme, path: fscm.EquilibriumPath) -> Figure:
    """The picture in a layout."""
    panels, size = LAYOUTS[layout]
    colours = dict.fromkeys(("text.color", "axes.labelcolor", "xtick.color", "ytick.color"), theme.text)
    faces = {"figure.facecolor": theme.page, "axes.facecolor": theme.page, "axes.edgecolor": theme.text}
    style = {"font.size": 9, "axes.titlesize": 10.5, "axes.titleweight": "bold", "axes.spines.top": False}
    with mpl.rc_context({**mpl.rcParamsDefault, **colours, **faces, **style, "axes.spines.right": False}):
        figure = Figure(figsize=size, layout="constrained")
        axes: dict[str, Axes] = figure.subplot_mosaic([list(row) for row in panels])  # type: ignore[assignment]
        before_contact(axes["before"], theme)
        in_contact(axes["contact"], theme)
        force_curve(axes["curve"], path, theme)
        surface_law(axes["law"], theme)
        figure.get_layout_engine().set(hspace=0.06, wspace=0.05)
    return figure


def checksum() -> str:
    """Checksum of this script."""
    return hashlib.sha256(Path(__file__).read_text(encoding="utf-8").encode()).hexdigest()


def write(folder: Path) -> None:
    """Write every layout in both themes into a folder."""
    path = fscm.trace(PROBLEM, "quick", max_load=1.3, with_bounds=False)
    stated = PngInfo()
    stated.add_text("Points", json.dumps(points(path)))
    stated.add_text("Script", checksum())
    for layout in LAYOUTS:
        for name, theme in THEMES.items():
            with io.BytesIO() as full:
                draw(layout, theme, path).savefig(full, dpi=200)
                # A palette makes the file a third as large.
                picture = Image.open(full).convert("RGB").quantize(128, dither=Image.Dither.NONE)
            picture.save(folder / f"contact-{layout}-{name}.png", optimize=True, pnginfo=stated)


if __name__ == "__main__":
    write(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parents[1] / "_static")

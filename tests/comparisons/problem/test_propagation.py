"""Uncertain values of a problem file: their text, and what follows from them for the force."""

import math
import re

import numpy as np
import pytest

from comparisons import evaluate
from comparisons.cli.main import main
from comparisons.description.uncertainty import uncertainty
from comparisons.problem.reading import load_problem
from comparisons.problem.uncertain import uncertain_in_si

#: Sensitivities that have to cancel: the error of the differences of kernels.
IDENTITY = 1e-6
#: Second order of the force in 5 %, relative to it: 2e-3 where the force is as curved as a square.
SECOND_ORDER = 3e-3

LAW = '[law]\nkind = "lennard-jones-9-3"\nwork_of_adhesion = "50 mJ/m^2 +- 4 %"\nz0 = "0.4 +- 0.02 nm"\n'
PUNCH = '[punch]\nkind = "sphere"\nR = "(100 +/- 5) nm"\n\n'
SOLID = """\
[solid]
kind = "power-law"
E0 = "1 GPa +- 0.05 GPa"
c0 = "100 nm +- 5 %"
k = "0.3 +- 0.02"
nu = "0.3 ± 0.02"
"""
COATING = """\
[solid]
kind = "coating"
E_coating = "1 GPa +- 5 %"
E_substrate = "5 GPa +- 5 %"
thickness = "20 nm +- 1 nm"
transition = "2 nm +- 5 %"
nu = "0.3 +- 0.02"
"""
PAD = SOLID + PUNCH + LAW
#: The same without uncertainties.
EXACT = re.sub(r" (\+-|±) (\d[.\d]*( %| GPa)?)", "", PAD.replace("(100 +/- 5) nm", "100 nm")).replace('"0.3"', "0.3")


def read(folder, text):
    path = folder / "pad.toml"
    path.write_text(text, encoding="utf-8")
    return load_problem(path)


@pytest.mark.parametrize(
    ("text", "value", "size"),
    [
        ("2 +- 0.1 GPa", 2e9, 1e8),
        ("2 GPa +- 100 MPa", 2e9, 1e8),
        ("2 GPa±5%", 2e9, 1e8),
        ("(2 ± 5%) GPa", 2e9, 1e8),
        ("2.0(1) GPa", 2e9, 1e8),
        ("200(10)e1 MPa", 2e9, 1e8),
        ("2 +- 5 % GPa", 2e9, 1e8),
        ("2.00(0.10) N/mm²", 2e6, 1e5),
        ("2e3 MPa +/- 1e2 MPa", 2e9, 1e8),
        ("[1.9, 2.1] GPa", 2e9, 1e8),
    ],
)
def test_forms(text, value, size):
    number, spread = uncertain_in_si(text, "Pa")
    assert math.isclose(number, value, rel_tol=1e-15)
    assert math.isclose(spread.size, size, rel_tol=1e-12)
    assert spread.is_interval == text.startswith("[")


def test_the_value_is_that_without_uncertainty(tmp_path):
    stated = read(tmp_path, PAD)
    assert stated.solid.values == {"E0": 1e9, "c0": 1e-7, "k": 0.3, "nu": 0.3}
    assert stated.content["punch"] == {"kind": "sphere", "R": 1e-7}
    assert list(stated.law.uncertain) == ["work_of_adhesion", "z0"]
    power = '[punch]\nkind = "power-law"\nn = "2 +- 0.1"\nQ = "1 um +- 5 %"\n\n'
    assert read(tmp_path, SOLID + power + LAW).punch.values == {"n": 2.0, "Q": 1e-6}


@pytest.mark.parametrize("solid", [SOLID, pytest.param(COATING, marks=pytest.mark.heavy)], ids=["power law", "coating"])
def test_units_of_force_and_of_length_change_the_force_alone_and_contributions_add_up(solid, tmp_path):
    stated = uncertainty(read(tmp_path, solid + PUNCH + LAW))
    by_name = {row["parameter"]: row["elasticity"] for row in stated["parameters"]}
    moduli = sum(value for name, value in by_name.items() if ".E" in name)
    work = by_name["law.work_of_adhesion"]
    lengths = sum(by_name.get(f"solid.{name}", 0.0) for name in ("c0", "thickness", "transition"))
    lengths += by_name["punch.R"] + by_name["law.z0"]
    assert (moduli + work, lengths) == pytest.approx((1.0, 2.0 * moduli + work), abs=IDENTITY)
    for row in stated["parameters"]:
        relative = row["standard_deviation"] / row["value"]
        assert row["contribution"] == pytest.approx(abs(row["elasticity"]) * relative * stated["value"])
    contributions = [row["contribution"] for row in stated["parameters"]]
    assert stated["standard_deviation"] == pytest.approx(math.hypot(*contributions), rel=1e-12)


INTERVALS = EXACT.replace('"1 GPa"', '"[0.9, 1.1] GPa"').replace('R = "100 nm"', 'R = "[95, 105] nm"')
INTERVALS = INTERVALS.replace("nu = 0.3", 'nu = "0.3 +- 0.02"')


def test_intervals_give_a_range(tmp_path):
    problem = read(tmp_path, INTERVALS)
    stated = uncertainty(problem)
    widths = [row["contribution"] for row in stated["parameters"] if "half_width" in row]
    assert len(widths) == 2
    assert math.isclose(np.diff(stated["range"]["first_order"])[0], 2.0 * sum(widths), rel_tol=1e-12)
    assert stated["range"]["is_monotone"]
    # The force rises with the radius; with the modulus as its slope says.
    sign = next(row["slope"] for row in stated["parameters"] if row["parameter"] == "solid.E0") > 0.0
    ends = []
    for R, E0 in ((9.5e-8, 0.9e9 if sign else 1.1e9), (1.05e-7, 1.1e9 if sign else 0.9e9)):
        changed = problem.with_value("solid.E0", E0).with_value("punch.R", R)
        ends.append(evaluate("fscm", "pull_off_force", changed).value)
    assert np.allclose(stated["range"]["solved"], ends, rtol=1e-9)
    assert np.allclose(stated["range"]["first_order"], ends, rtol=SECOND_ORDER)


def test_the_command_prints_what_follows(tmp_path, capsys):
    read(tmp_path, INTERVALS)
    path = str(tmp_path / "pad.toml")
    assert main(["describe", path, "--uncertain", "--quantity", "zero_load_displacement"]) == 0
    text = capsys.readouterr().out
    head = "uncertainty of zero_load_displacement = "
    for words in (head, "solid.E0", "[0.9, 1.1] GPa", "standard deviation", "for independent", "range over"):
        assert words in text


def test_an_event_that_does_not_exist_has_a_reason(tmp_path):
    stated = uncertainty(read(tmp_path, PAD.replace("1 GPa +- 0.05 GPa", "100 GPa +- 5 %")), "jump_in_gap")
    assert (stated["status"], bool(stated["reason"])) == ("not-applicable", True)


@pytest.mark.parametrize(
    ("text", "options", "sentence"),
    [
        (PAD, ["--uncertain", "--quantity", "force"], "unknown quantity 'force'"),
        (PAD, ["--uncertain", "--quantity", "hysteresis_energy"], "none of those with a sensitivity"),
        (PAD, ["--quantity", "pull_off_force"], "--quantity is that of --uncertain"),
        (EXACT, ["--uncertain"], "no value has an uncertainty; write one as"),
    ],
)
def test_bad_requests(text, options, sentence, tmp_path, refused):
    (tmp_path / "pad.toml").write_text(text, encoding="utf-8")
    refused(["describe", tmp_path / "pad.toml", *options], sentence)

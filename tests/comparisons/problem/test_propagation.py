"""Uncertain values of a problem file: their text, and what follows from them for the force."""

import json
import math
import re

import numpy as np
import pytest

from comparisons import evaluate
from comparisons.cli.main import main
from comparisons.description.uncertainty import uncertainty
from comparisons.problem.reading import load_problem
from comparisons.problem.uncertain import is_uncertain, uncertain_in_si

#: Sensitivities that have to cancel: the error of the differences of kernels.
IDENTITY = 1e-6
#: Second order of the force in 5 %, relative to it: 2e-3 where the force is as curved as a square.
SECOND_ORDER = 3e-3
#: So many standard errors of the mean and of the standard deviation of a sample.
ERRORS = 3.0

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
        ("(2 +- 0.1) GPa", 2e9, 1e8),
        ("2 GPa +- 100 MPa", 2e9, 1e8),
        ("2 GPa±5%", 2e9, 1e8),
        ("2e3 MPa +/- 1e2 MPa", 2e9, 1e8),
        ("[1.9, 2.1] GPa", 2e9, 1e8),
    ],
)
def test_forms(text, value, size):
    assert is_uncertain(text)
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


def dimensions(stated):
    """What units of force and of length change: nothing but the force itself."""
    by_name = {row["parameter"]: row["elasticity"] for row in stated["parameters"]}
    moduli = sum(value for name, value in by_name.items() if ".E" in name)
    work = by_name["law.work_of_adhesion"]
    lengths = sum(by_name.get(f"solid.{name}", 0.0) for name in ("c0", "thickness", "transition"))
    lengths += by_name["punch.R"] + by_name["law.z0"]
    return moduli + work - 1.0, lengths - 2.0 * moduli - work


def draws(problem, stated, count, seed):
    """Forces of a sample of the parameters, and the same to first order."""
    generator = np.random.default_rng(seed)
    exact, linear = [], []
    for _ in range(count):
        changed, change = problem, 0.0
        for row in stated["parameters"]:
            shift = generator.normal() * row["standard_deviation"]
            changed = changed.with_value(*row["parameter"].split("."), row["value"] + shift)
            change += row["slope"] * shift
        exact.append(evaluate("fscm", stated["quantity"], changed).value)
        linear.append(stated["value"] + change)
    return np.array(exact), np.array(linear)


def check_sample(problem, count, seed):
    stated = uncertainty(problem)
    assert max(map(abs, dimensions(stated))) < IDENTITY
    sizes = [row["contribution"] for row in stated["parameters"]]
    assert math.isclose(stated["standard_deviation"], math.sqrt(sum(size**2 for size in sizes)), rel_tol=1e-12)
    exact, linear = draws(problem, stated, count, seed)
    assert np.max(np.abs(exact - linear)) < SECOND_ORDER * stated["value"] * 4.0
    assert np.mean(np.abs(exact - linear)) < SECOND_ORDER * stated["value"]
    deviation = stated["standard_deviation"]
    error_of_mean = ERRORS * deviation / math.sqrt(count) + SECOND_ORDER * stated["value"]
    assert abs(np.mean(exact) - stated["value"]) < error_of_mean
    assert abs(np.std(exact, ddof=1) / deviation - 1.0) < ERRORS / math.sqrt(2.0 * (count - 1))


@pytest.mark.heavy
@pytest.mark.parametrize("solid", [SOLID, COATING], ids=["power law", "coating"])
def test_a_large_sample(solid, tmp_path):
    check_sample(read(tmp_path, solid + PUNCH + LAW), 40, seed=17)


INTERVALS = PAD.replace("1 GPa +- 0.05 GPa", "[0.9, 1.1] GPa").replace("(100 +/- 5) nm", "[95, 105] nm")


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
        changed = problem.with_value("solid", "E0", E0).with_value("punch", "R", R)
        ends.append(evaluate("fscm", "pull_off_force", changed).value)
    assert np.allclose(stated["range"]["solved"], ends, rtol=1e-9)
    assert np.allclose(stated["range"]["first_order"], ends, rtol=SECOND_ORDER)


def test_the_command_prints_what_follows(tmp_path, capsys):
    read(tmp_path, INTERVALS)
    path = str(tmp_path / "pad.toml")
    assert main(["describe", path, "--uncertain"]) == 0
    text = capsys.readouterr().out
    for words in ("uncertainty of pull_off_force = ", "solid.E0", "[0.9, 1.1] GPa", "standard deviation", "range over"):
        assert words in text
    assert main(["describe", path, "--uncertain", "--format", "json", "--quantity", "zero_load_displacement"]) == 0
    stated = json.loads(capsys.readouterr().out)["uncertainty"]
    assert (stated["quantity"], stated["unit"], stated["status"]) == ("zero_load_displacement", "m", "ok")
    assert stated["range"]["is_monotone"] is True


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
def test_bad_requests(text, options, sentence, tmp_path, capsys):
    (tmp_path / "pad.toml").write_text(text, encoding="utf-8")
    assert main(["describe", str(tmp_path / "pad.toml"), *options]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    assert sentence in captured.err

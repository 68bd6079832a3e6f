"""Texts of others that are large, deep or out of range: one sentence, before they cost time and memory."""

import tracemalloc

import pytest

from comparisons.data import validation
from comparisons.data.folder_entries import TooMany, entries_below
from comparisons.data.toml_text import parse
from comparisons.data.validation import known_name, validated


@pytest.mark.parametrize("number", ["4_0_0", "\u0661", "1_0"])
@pytest.mark.parametrize("option", ["--mu", "--n", "--k", "--nu"])
def test_an_underscore_or_another_digit_is_no_number(option, number, refused):
    numbers = {"--n": "2", "--k": "0", "--mu": "1"} | {option: number}
    words = [word for pair in numbers.items() for word in pair]
    refused(["solve", "--model", "jkr", "--quantity", "pull_off_force", *words], option, "not a number")


@pytest.mark.parametrize("option", ["--jobs", "--random", "--seed"])
def test_nor_is_it_an_integer(option, refused):
    refused(["run", option, "1_0"], option, "not an integer")


KEYS = [f"a{'.a' * 2_000} = 1", f"[a{'.a' * 2_000}]", 'x = [{"a" . b' + ".'c'" * 40 + " = 1}]"]


@pytest.mark.parametrize("text", KEYS, ids=["key", "table", "inline"])
def test_a_deep_key_is_refused_before_it_is_parsed(text):
    tracemalloc.start()
    with pytest.raises(ValueError, match="nested too deeply"):
        parse(text, "a.toml")
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 2e6


def test_dots_in_numbers_and_texts_are_no_keys():
    numbers = ", ".join(["0.1"] * 1000)
    tables = parse(f'a.b.c = [{numbers}]\nd = "one. two. three"\n[e.f]\ng = 1.5', "a.toml")
    assert (len(tables["a"]["b"]["c"]), tables["e"]["f"]["g"]) == (1000, 1.5)


@pytest.mark.parametrize("digits", ["0x" + 20_000 * "f", "0b" + 5000 * "1"], ids=["hexadecimal", "binary"])
def test_an_integer_that_no_sentence_can_show_is_refused(digits):
    with pytest.raises(ValueError, match="bits"):
        parse(f"a = [{{ b = {digits} }}]", "a.toml")
    assert parse(f"a = {10**400}", "a.toml") == {"a": 10**400}


def test_the_end_of_a_pattern_is_the_end_of_the_text():
    validated({"gate": [_gate()]}, "gates", "x")
    with pytest.raises(ValueError, match="capitals"):
        validated({"gate": [_gate(id="A-GATE\n")]}, "gates", "x")


def _gate(**changes):
    texts = dict.fromkeys(("requirement", "quantity", "candidate", "reference", "grounds"), "x") | {"id": "A-GATE"}
    choices = {"metric": "rel", "basis": "derived", "tier": "quick", "cases": {}}
    numbers = {"lower": -1, "upper": 1, "max_reference_uncertainty": 1, "min_cases": 1}
    return texts | choices | numbers | changes


def test_of_very_many_errors_a_few_are_looked_at(monkeypatch):
    counted = []
    real = validation._position
    monkeypatch.setattr(validation, "_position", lambda error: counted.append(error) or real(error))
    with pytest.raises(ValueError, match="gate 1"):
        validated({"gate": [{}] * 5000}, "gates", "x")
    assert len(counted) <= 100


def test_the_nearest_name_of_a_very_long_one_is_not_searched():
    with pytest.raises(ValueError, match="known are jkr"):
        known_name("model", "jkr" * 10**6, ["jkr"], "x")
    with pytest.raises(ValueError, match="did you mean jkr"):
        known_name("model", "jrk", ["jkr"], "x")


def test_entries_are_counted_with_the_folders_and_no_link_is_followed(tmp_path):
    (tmp_path / "a" / "b").mkdir(parents=True)
    (tmp_path / "a" / "file").touch()
    (tmp_path / "a" / "loop").symlink_to(tmp_path)
    assert {entry.name for entry in entries_below(tmp_path, 4)} == {"a", "b", "file", "loop"}
    with pytest.raises(TooMany):
        list(entries_below(tmp_path, 3))
    assert {entry.name for entry in entries_below(tmp_path, 1, lambda _: False)} == {"a"}

"""Problem files that `new-problem` writes: every kind is read at once, and so is every key that stands as a comment."""

import pytest

from comparisons.cli.main import main
from comparisons.problem import Problem
from comparisons.problem.kinds import KINDS, PUNCH_SOLID, SECTIONS

KIND_NAMES = [f"{section}.{kind}" for section in (*SECTIONS, PUNCH_SOLID) for kind in KINDS[section]]


def written(folder, *kinds):
    """Path of the file that the command writes."""
    path = folder / "pad.toml"
    assert main(["new-problem", *kinds, "--out", str(path)]) == 0
    return path


@pytest.mark.parametrize("name", KIND_NAMES)
def test_a_file_of_every_kind_is_read_and_has_its_keys(name, tmp_path, capsys):
    section, kind = name.split(".")
    path = written(tmp_path, name)
    assert str(path) in capsys.readouterr().out
    problem = Problem.load(path)
    assert problem.section(section).kind == kind
    lines = path.read_text(encoding="utf-8").partition(f"[{section}]")[2].partition("\n[")[0].splitlines()
    for key in KINDS[section][kind].keys:
        assert sum(line.removeprefix("# ").startswith(f"{key} = ") for line in lines) == 1


@pytest.mark.parametrize("name", KIND_NAMES)
def test_a_key_that_stands_as_a_comment_is_admissible(name, tmp_path):
    section, kind = name.split(".")
    path = written(tmp_path, name)
    text = path.read_text(encoding="utf-8")
    head, _, rest = text.partition(f"[{section}]")
    for key in KINDS[section][kind].optional:
        path.write_text(f"{head}[{section}]{rest.replace(f'# {key} = ', f'{key} = ', 1)}", encoding="utf-8")
        assert key in Problem.load(path).section(section).values
    if kind == "coating":
        both = rest.replace("\nnu = ", "\n# nu = ", 1)
        for key in ("nu_coating", "nu_substrate"):
            both = both.replace(f"# {key} = ", f"{key} = ", 1)
        path.write_text(f"{head}[{section}]{both}", encoding="utf-8")
        assert Problem.load(path).section(section)["nu_substrate"] != Problem.load(path).section(section)["nu_coating"]


def test_the_solver_takes_a_file_at_once(tmp_path, capsys):
    path = written(tmp_path, "cone")
    assert main(["solve", "--model", "fscm", "--quantity", "pull_off_force", "--problem", str(path)]) == 0
    assert "-P_c = " in capsys.readouterr().out


@pytest.mark.heavy
@pytest.mark.parametrize("name", KIND_NAMES)
def test_describe_takes_a_file_of_every_kind(name, tmp_path, capsys):
    assert main(["describe", str(written(tmp_path, name))]) == 0
    assert "pull-off force" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("kinds", "sentence"),
    [
        (["table"], "solid.table or punch.table or law.table"),
        (["coating", "homogeneous"], "both a solid"),
        (["coatin"], "did you mean coating"),
        (["punch.coating"], "unknown kind 'coating'"),
        (["homogeneous", "sphere", "punch_solid"], "punch_solid.homogeneous"),
        (["punch"], "punch.sphere"),
        (["wall.coating"], "unknown section 'wall'"),
    ],
)
def test_what_is_no_kind_is_one_sentence(kinds, sentence, tmp_path, refused):
    refused(["new-problem", *kinds, "--out", tmp_path / "pad.toml"], sentence)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["pad.toml", "law.csv"])
def test_no_file_is_written_over(name, tmp_path, refused):
    (tmp_path / name).write_text("mine", encoding="utf-8")
    refused(["new-problem", "law.table", "--out", tmp_path / "pad.toml"], f"{name} exists")
    assert [path.name for path in tmp_path.iterdir()] == [name]
    assert (tmp_path / name).read_text(encoding="utf-8") == "mine"

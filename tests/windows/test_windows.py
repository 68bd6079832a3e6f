"""Windows, as far as another system can show it: what it lacks is blocked in a process (`shim/sitecustomize.py`).

On Windows itself the same commands run without the shim.
"""

import json
import os
import re
import subprocess
import sys
from hashlib import sha256
from pathlib import Path

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.console.readable import readable
from comparisons.external.text_rules import is_portable
from tests.paths import ROOT
from tests.test_packaging import repository

EXAMPLES = ROOT / "docs" / "examples"
SHIM = Path(__file__).with_name("shim")
WITH_SHIM = pytest.mark.skipif(sys.platform != "linux", reason="the shim reads /proc")

#: Only code that another program calls on POSIX alone: `connect` refuses it on Windows before it is needed.
POSIX_ONLY = {f"comparisons/external/{name}.py" for name in ("child", "cleaner", "landlock", "mounts", "start")}

#: Predictions as data: no code of a user runs.
MANIFEST = """name = "told"
version = "1"
author = "A"
doi = "none"
licence = "CC-BY-4.0"
domain = "n = 2, k = 0"
predictions = "predictions.csv"
sha256 = "{digest}"
[units]
pull_off_force = "pi Q^(2/n) dgamma z0^(2/n-1)"
[[covers]]
quantities = ["pull_off_force"]
n = [2]
k = [0]
mu = [1]
"""
PREDICTIONS = b"quantity,n,k,mu,value,u_num\r\npull_off_force,2,0,1,1.6,0.01\r\n"


def called(arguments, folder, encoding="cp437"):
    """Run Python in a folder as on Windows: texts in an old code page, and a locale that is not UTF-8."""
    variables = {
        "PYTHONIOENCODING": encoding,
        "PYTHONUTF8": "0",
        "PYTHONCOERCECLOCALE": "0",
        "LC_ALL": "C",
        "PYTHONPATH": os.pathsep.join([str(SHIM), str(ROOT)] if sys.platform == "linux" else [str(ROOT)]),
        "FSCM_BENCH_WINDOWS": str(folder),
        "PYTHONWARNDEFAULTENCODING": "1",
        "OPENBLAS_NUM_THREADS": "1",
    }
    environment = os.environ | variables
    return subprocess.run([sys.executable, *arguments], cwd=folder, env=environment, capture_output=True, check=False)


def statuses(commands, folder, **options):
    """The exit statuses of commands of one process, and what they printed on stdout and stderr."""
    done = called(["-m", "tests.windows.commands", "statuses.json", json.dumps(commands)], folder, **options)
    assert done.returncode == 0, done.stderr.decode(errors="replace")
    return json.loads((folder / "statuses.json").read_text(encoding="utf-8")), done.stdout, done.stderr


def with_windows_line_ends(source, target):
    """Copy a text with the line ends of Windows."""
    target.write_bytes(source.read_bytes().replace(b"\r\n", b"\n").replace(b"\n", b"\r\n"))


@pytest.fixture
def folder(tmp_path):
    """A folder with a problem and predictions whose lines end as on Windows."""
    with_windows_line_ends(EXAMPLES / "problems" / "probe.toml", tmp_path / "probe.toml")
    (tmp_path / "told").mkdir()
    (tmp_path / "told" / "predictions.csv").write_bytes(PREDICTIONS)
    manifest = MANIFEST.format(digest=sha256(PREDICTIONS).hexdigest())
    (tmp_path / "told" / "model.toml").write_bytes(manifest.encode().replace(b"\n", b"\r\n"))
    return tmp_path


def test_the_commands_work(folder, tmp_path_factory):
    sweep = ["sweep", "--problem", "probe.toml", "--vary", "punch.R=50nm,100nm", "--model", "jkr"]
    compare = ["compare", "jkr", "told", "--n", "2", "--k", "0", "--mu", "1"]
    commands = [
        ["list", "quantities"],
        ["new-problem", "--out", "my.toml"],
        ["describe", "probe.toml"],
        ["solve", "--model", "fscm", "--quantity", "pull_off_force", "--problem", "probe.toml"],
        ["curve", "--model", "jkr", "--n", "2", "--k", "0", "--mu", "1", "--csv", "curve.csv", "--plot", "curve.png"],
        [*sweep, "--out", "radii"],
        [*sweep, "--out", "radii"],
        [*compare, "--out", "compared"],
        ["report", "compared"],
        ["report", "compared"],
        ["cite", "compared", "--format", "bibtex"],
        ["paper", "--figure", "2", "--jobs", "1", "--out", "paper"],
        ["new-model", "mine"],
    ]
    # What needs another system is refused in one sentence.
    refused = [["check-model", "mine/mine.py:Mine"], ["bench", "--out", "bench"]]
    status, stdout, stderr = statuses([*commands, *refused], folder)
    assert status == [0] * len(commands) + [2] * len(refused), stderr.decode(errors="replace")
    last = stderr.decode("cp437").splitlines()[-2:]
    assert ["Linux and macOS" in last[0], "--only work-precision" in last[1]] == [True, True]
    # What an old code page cannot hold is readable: the heading of the Tabor number, and kappa.
    assert {"mu", "kappa"} <= set(stdout.decode("cp437").replace("|", " ").split())
    assert b"\\u" not in stdout
    # The same results as here, of a file with other line ends.
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    assert main([*sweep[:2], str(EXAMPLES / "problems" / "probe.toml"), *sweep[3:], "--out", str(elsewhere)]) == 0
    columns = ["model", "quantity", "problem", "value", "u_num", "status"]
    tables = [pd.read_csv(run / "results.csv")[columns] for run in (folder / "radii", elsewhere)]
    pd.testing.assert_frame_equal(*tables)
    assert b"\r" not in (folder / "radii" / "results.csv").read_bytes()


def test_every_module_can_be_imported(folder):
    names = [
        path.relative_to(ROOT).with_suffix("")
        for top in ("comparisons", "fem_reference", "fscm")
        for path in (ROOT / top).rglob("*.py")
    ]
    modules = [".".join(name.parts).removesuffix(".__init__") for name in names if "_entry" not in str(name)]
    wanted = [name for name in sorted(modules) if not name.endswith("__main__")]
    code = "import importlib, sys; [importlib.import_module(name) for name in sys.argv[1:]]"
    done = called(["-c", code, *wanted], folder)
    assert (done.returncode, done.stderr.decode(errors="replace")) == (0, "")
    assert len(wanted) > 300


#: What a module of this project does, and the error that Windows has for it.
REFUSED = {
    "import fcntl": "ModuleNotFoundError",
    "from os import killpg": "ImportError",
    "import os; os.O_NONBLOCK": "AttributeError",
    "import signal; signal.pthread_sigmask": "AttributeError",
    "import sys; assert sys.platform != 'win32'": "AssertionError",
    "open('aux.txt', 'w', encoding='utf-8')": "OSError",
    "open('a:b', 'wb')": "OSError",
    "from pathlib import Path; Path('end.').mkdir()": "OSError",
    "open('PROBE.toml', 'wb')": "FileExistsError",
    "open('probe.toml')": "EncodingWarning",
    "import os; file = open('a', 'wb'); os.replace('probe.toml', 'a')": "PermissionError",
    "import os; file = open('a', 'wb'); os.remove('a')": "PermissionError",
    "import os; os.symlink('probe.toml', 'b')": "PermissionError",
}


@WITH_SHIM
def test_the_shim_refuses_what_windows_refuses(folder):
    code = f"""
for code in {list(REFUSED)!r}:
    try:
        exec(code, {{"__name__": "comparisons.module"}})
        print("nothing")
    except Exception as error:
        print(type(error).__name__)
"""
    printed = called(["-c", code], folder).stdout.decode().split()
    assert dict(zip(REFUSED, printed, strict=True)) == REFUSED


def test_every_character_of_the_texts_is_readable_in_ascii():
    # Not what is written for LaTeX and for a browser.
    unprinted = {"assets", "latex.py", "style.py"}
    files = [path for path in (ROOT / "comparisons").rglob("*.*") if path.suffix in (".py", ".toml")]
    texts = "".join(path.read_text(encoding="utf-8") for path in files if unprinted.isdisjoint(path.parts))
    unreadable = {character for character in texts if not character.isascii() and readable(character).startswith("\\")}
    assert unreadable == {"山"}  # an example of the rule


def test_every_file_of_the_repository_has_a_name_that_windows_can_hold():
    names = repository()
    assert [name for name in names if not all(is_portable(part) for part in name.split("/"))] == []
    assert len({name.lower() for name in names}) == len(names)
    assert max(map(len, names)) < 150  # of 260 with the folder of the clone


@pytest.mark.lint
@pytest.mark.parametrize("platform", ["win32", "darwin"])
def test_names_that_a_system_lacks_are_used_only_where_it_refuses_before(platform, tmp_path):
    command = [sys.executable, "-m", "mypy", "--platform", platform, "--cache-dir", str(tmp_path)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, encoding="utf-8", check=False)
    errors = re.findall(r"^(.*?):\d+: error: .*$", done.stdout, flags=re.MULTILINE)
    assert "checked" in done.stdout
    assert set(errors) <= POSIX_ONLY

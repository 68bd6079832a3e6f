"""Tables of the kinds of a problem file, between comments ``<!-- kinds of solid -->`` and ``<!-- end of kinds -->``.

python docs/kind_tables.py        # writes them into docs/problem_files.md again

They follow from `comparisons/data/kinds.toml`; a test says when the page is out of date.
"""

import re
from pathlib import Path

from comparisons.data.toml_text import shipped
from comparisons.problem.kinds import kind_rows

PAGE = Path(__file__).parent / "problem_files.md"

_TABLE = re.compile(r"<!-- kinds of (\w+) -->\n.*?<!-- end of kinds -->", flags=re.DOTALL)


def with_tables(text: str) -> str:
    """A page with the tables of today."""
    return _TABLE.sub(lambda match: f"<!-- kinds of {match[1]} -->\n{_table(match[1])}\n<!-- end of kinds -->", text)


def _table(section: str) -> str:
    # The text of the page has the keys of every kind.
    of_every = [f"perhaps {key}" for key in shipped("kinds.toml")["every"].get(section, {}).get("keys", {})]
    lines = ["", "| kind | formula | keys |", "|---|---|---|"]
    for row in kind_rows():
        if row["section"] == section:
            keys = ", ".join(key for key in row["keys"].split(", ") if not key.startswith(tuple(of_every)))
            columns = f"; columns `{row['columns']}`" if row["columns"] else ""
            lines.append(f"| `{row['kind']}` | {row['formula']} | `{keys}`{columns} |")
    return "\n".join([*lines, ""])


if __name__ == "__main__":
    PAGE.write_text(with_tables(PAGE.read_text(encoding="utf-8")), encoding="utf-8")

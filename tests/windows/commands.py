"""Commands in one process, for the test that runs them as on Windows: their exit statuses become a file.

python -m tests.windows.commands STATUSES.json '[["list", "models"], ...]'
"""

import json
import sys
from pathlib import Path

from comparisons.cli.main import main

if __name__ == "__main__":
    statuses = [main(arguments) for arguments in json.loads(sys.argv[2])]
    Path(sys.argv[1]).write_text(json.dumps(statuses), encoding="utf-8")

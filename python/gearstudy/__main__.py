"""The command line: ``gearstudy``, ``python -m gearstudy``."""

import os
import signal
import sys

from gearstudy._gearstudy import command_line


def main() -> None:
    # The program hears Ctrl-C itself, and ends as it does elsewhere.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(command_line(["gearstudy", *map(os.fsdecode, sys.argv[1:])]))


if __name__ == "__main__":
    main()

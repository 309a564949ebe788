"""The command line: ``gearstudy``, ``python -m gearstudy``."""

import sys

from gearstudy._gearstudy import command_line


def main() -> None:
    sys.exit(command_line(["gearstudy", *sys.argv[1:]]))


if __name__ == "__main__":
    main()

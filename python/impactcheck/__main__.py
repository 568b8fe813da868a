"""`python -m impactcheck`, and the command `impactcheck`: the program itself."""

import sys

from impactcheck import _core


def main() -> None:
    """Run the program with this process' arguments, and end as it ends."""
    sys.exit(_core.main(["impactcheck", *sys.argv[1:]]))


if __name__ == "__main__":
    main()

"""`python -m impactcheck`: the program itself."""

import subprocess
import sys

from impactcheck._program import program

sys.exit(subprocess.run([program(), *sys.argv[1:]]).returncode)

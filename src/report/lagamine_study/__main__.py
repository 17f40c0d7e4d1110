"""`python -m lagamine_study`."""
import sys

from .command import main

sys.exit(main(sys.argv[1:], version="of the source tree"))

"""`python3 -m lagamine_import`: as `lagaimport`, without having been installed."""
import sys

from .command import main

sys.exit(main(sys.argv[1:], version="of the source tree"))

"""Curves of a run: `plot.py --help` says how to call it. The package burnish beside this file draws them."""
from burnish.plot import main

main()

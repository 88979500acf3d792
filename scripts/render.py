"""Pictures of a run: `render.py --help` says how to call it. The package burnish beside this file draws them."""
from burnish.render import main

main()

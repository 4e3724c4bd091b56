"""The program, run as a folder, `python checker FILE.json`, or as a module."""

import os
import runpy
import sys

if __name__ == "__main__":
    if __package__:
        from .files import main

        sys.exit(main(sys.argv[1:]))
    # the files import one another as those of a package, which has the folder's name
    sys.path[0], folder = os.path.split(os.path.abspath(sys.path[0]))
    runpy.run_module(folder, run_name="__main__")

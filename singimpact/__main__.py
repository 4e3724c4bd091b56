"""`python -m singimpact` is the command `singimpact`."""

from singimpact.cli import main

if __name__ == "__main__":
    main()

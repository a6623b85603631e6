"""`python -m etendue` is the command `etendue`."""

from .cli import main

if __name__ == "__main__":
    main()

"""The command `lwa`, also as `python -m lwa`."""

from lwa.command.interrupt import start


def main() -> None:
    """Entry point of `python -m lwa`, which then loads the command."""
    start("lwa", "lwa.command.cli")


if __name__ == "__main__":
    main()

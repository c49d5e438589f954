"""The command `lwa`, also as `python -m lwa`."""

from lwa.command.interrupt import start


def main() -> None:
    """Entry point, which loads the command's parts when it is called."""
    start("lwa", "lwa.command.cli")


if __name__ == "__main__":
    main()

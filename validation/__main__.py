"""The command `lwa-validate`, also as `python -m validation`."""

from lwa.__main__ import start


def main() -> None:
    """Entry point, which loads the command's parts when it is called."""
    start("lwa-validate", "validation.cli")


if __name__ == "__main__":
    main()

"""The picture that opens the README, of the last run of the tests: `python -m tests.view.picture`."""

from pathlib import Path

from PIL import Image

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "build" / "view" / "laptop_light.png"
TARGET = ROOT / "docs" / "viewer.png"
COLOURS = 160


def main() -> None:
    """Write the picture with few colours, so that it is small."""
    with Image.open(SOURCE) as picture:
        picture.convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE).save(TARGET, optimize=True)


if __name__ == "__main__":
    main()

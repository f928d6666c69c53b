"""Record what a package answers: `python -m tests.corpus.record [--anew] [--package DIR] [--output DIR] [NAME ...]`."""

from pathlib import Path

from tests.corpus.compare import options, use


def main() -> None:
    """Ask the recorded questions again, or new ones, and keep the answers."""
    parser = options(__doc__)
    parser.add_argument("--anew", action="store_true", help="draw new questions, too")
    parser.add_argument("--output", type=Path, metavar="DIR", help="another folder for the recordings")
    given = parser.parse_args()
    use(given.package)
    from tests.corpus.recording import NAMES, RECORDED, asked_again, drawn, read, write

    total = 0
    for name in given.names or NAMES:
        is_new = given.anew or not (RECORDED / f"{name}.json.xz").exists()
        found = drawn(name) if is_new else asked_again(read(name))
        size = write(name, found, given.output or RECORDED)
        total += size
        asked = sum(len(part["asked"]) for part in found)
        print(f"{name:32}{len(found):4} robots {asked:5} questions {size:8} bytes", flush=True)
    print(f"{total} bytes in all")


if __name__ == "__main__":
    main()

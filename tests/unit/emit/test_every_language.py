"""One machine goes through every stage and into every language, as `make generate` takes it."""

from derive.command.catalogue import OUTPUT
from derive.pipeline import LANGUAGES, WRITTEN, derive_one, files_of, languages
from tests.mechanisms import named

NAME = "Kin_Scara2_Z"


def test_what_is_written_is_what_is_committed() -> None:
    """Its files are those of `generated/`, byte for byte, and the languages that are not committed write it as well."""
    built = derive_one(named(NAME))
    assert built.measured and not built.undrawn
    files = files_of([built], languages(None, wanted=LANGUAGES))
    own = {path: data for path, data in files.items() if "scara2_z" in path.lower()}
    assert {path.split("/")[0] for path in own} == set(LANGUAGES)
    committed = [path for path in own if path.startswith(WRITTEN)]
    assert len(committed) >= 8
    for path in committed:
        assert own[path] == (OUTPUT / path).read_bytes(), path

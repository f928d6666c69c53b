"""The names on a page: spelled as the function block has them, and in Python with underscores between the words."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache

from derive.emit.python import entries as python
from derive.emit.softmotion import inputs as block
from derive.emit.softmotion.block import block_of
from derive.emit.softmotion.library import most_axes
from derive.emit.softmotion.methods import spelled_inputs
from derive.emit.st.contract import load
from derive.emit.st.names import parameter_name, spellings
from derive.emit.st.shared import structures_of
from derive.ir.program import Program
from derive.ir.tree import bound_in
from derive.kinematics.kinematics import Kinematics
from derive.report.branch_stretches import stretches_of


@dataclass(frozen=True)
class Spelling:
    """How a page spells neutral names."""

    known: Mapping[str, str]
    places: tuple[tuple[str, str], ...]
    """Names on the page that the block holds in a structure: each with its place there."""

    def __call__(self, name: str) -> str:
        """The spelling of a neutral name: `cos_a2` → `cosA2`."""
        return self.known.get(name) or parameter_name(name)

    def text(self, text: str) -> str:
        """A sentence in which neutral names are spelled as on the page."""
        words = (self(word) if word in self.known else word for word in _split(text))
        return "".join(words)


def has_block(kinematics: Kinematics) -> bool:
    """Whether there is a function block: SoftMotion knows no more than six axes."""
    return len(kinematics.mechanism.joints) <= _most_axes()


@cache
def _most_axes() -> int:
    return most_axes(None)


def inputs_of(kinematics: Kinematics) -> Mapping[str, str]:
    """The parameters by their neutral names, as inputs of the block, if there is one, else of the class in Python."""
    found = block.inputs(kinematics) if has_block(kinematics) else python.inputs(kinematics)
    return found.names


def spelling_of(kinematics: Kinematics) -> Spelling:
    """The spelling of every name in the programs of a machine."""
    programs = (kinematics.setup, *kinematics.programs)
    taken = list(inputs_of(kinematics).values())
    given: dict[str, str] = {}
    if has_block(kinematics):
        taken += [i.name for i in block_of(kinematics, load(None)).inputs]
        given = spelled_inputs(kinematics) | {c: f"v.d{c.upper()}" for c in "xyz"}
    plain = {name: text for name, text in given.items() if text.isidentifier()}
    own = [name for name in _names(kinematics, programs) if name not in plain]
    known = plain | spellings(own, (*taken, *plain.values()))
    read = {s.name for program in programs[1:] for s in program.inputs}
    places = [(known[n], text) for n, text in given.items() if not text.isidentifier() and n in read]
    if given:
        places += [(known[n], text) for n, text in _held_elsewhere(kinematics) if n in known]
    return Spelling(known, tuple(places))


def _held_elsewhere(kinematics: Kinematics) -> Iterator[tuple[str, str]]:
    """The results of shared programs that stand in a structure, and the values that the base block finds, next to
    which a turn is chosen: each with its spelling there.
    """
    for program, structure in structures_of(kinematics.shared):
        yield from ((o.name, f"{structure.variable}.{structure.fields[o.name]}") for o in program.outputs)
    for index, joint in enumerate(kinematics.mechanism.joints):
        if joint in kinematics.period_joints:
            yield f"near_{joint.key}", f"choice.aNear[{index}]"
            yield f"open_{joint.key}", f"choice.aNear[{index}], where no turn is commanded"


def _names(kinematics: Kinematics, programs: Sequence[Program]) -> list[str]:
    """All names, each once, in the order of the programs; those of the branch first."""
    found = [name.name for stretch in stretches_of(kinematics.branch) for name in bound_in(stretch.items)]
    for program in programs:
        found += [s.name for s in program.inputs]
        found += [name.name for statement in program.body for name in statement.bound()]
    return list(dict.fromkeys(found))


def _split(text: str) -> list[str]:
    """The words of a text, and the characters between them."""
    found: list[str] = []
    for letter in text:
        is_word = letter.isalnum() or letter == "_"
        if found and is_word and (found[-1][-1].isalnum() or found[-1][-1] == "_"):
            found[-1] += letter
        else:
            found.append(letter)
    return found

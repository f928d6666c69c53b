"""C, JavaScript and FMUs: how a machine is written in each, and how it is asked."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from derive.description.mechanism import Mechanism
from derive.emit.c import package as in_c
from derive.emit.fmu import package as in_fmu
from derive.emit.javascript import package as in_javascript
from derive.emit.language import Part
from derive.kinematics.kinematics import Kinematics
from tests.c import machine as driver
from tests.c import programs
from tests.fmu import simulated
from tests.javascript import comparison, modules, node
from tests.mechanisms import kinematics_of

Answer = dict[str, Any]


@dataclass(frozen=True)
class Language:
    """What the tests need of it."""

    name: str
    part: Callable[[Kinematics], Part | None]
    written: Callable[[Part], Any]
    """The program, the module or the FMU of what is written."""
    of_catalogue: Callable[[str], Any]
    ask: Callable[[Any, list[Answer]], list[Answer]]
    """What machines answer, {"parameters": …, "calls": …} each."""
    parameters: Callable[[Any], Sequence[Answer]]
    asked: Callable[[Any], Callable[[Answer], Answer | None]]
    """A question of the corpus as the language can put it."""
    words: Mapping[str, str]
    """Inputs that are called otherwise than in Python."""

    def __str__(self) -> str:
        return self.name

    def of(self, mechanism: Mechanism) -> Any:
        """The program, or the module, of a machine of a user's own."""
        part = self.part(kinematics_of(mechanism))
        assert part is not None
        return self.written(part)

    def compared(self, program: Any, recording: list[Answer]) -> list[comparison.Comparison]:
        return comparison.compared(recording, lambda machines: self.ask(program, machines), self.asked(program))


def _as_c_can(program: Path) -> Callable[[Answer], Answer | None]:
    known = driver.described(program)
    return lambda question: driver.said(question, known)


_NAMES = {word: word for word in ("self", "configuration", "lambda", "del")}
C = Language(
    "C", in_c.part, programs.compiled, programs.program_of, driver.ask,
    lambda program: driver.described(program).parameters, _as_c_can, _NAMES | {"int": "int_length"},
)  # fmt: skip
JAVASCRIPT = Language(
    "JavaScript", in_javascript.part, modules.written, modules.module_of,
    lambda module, machines: node.ask(module, machines)["answers"],
    lambda module: node.ask(module, [])["description"]["parameters"], lambda module: dict, _NAMES,
)  # fmt: skip
FMU = Language(
    "FMU", in_fmu.part, simulated.written, simulated.fmu_of, simulated.ask, lambda fmu: [], simulated.asked, {}
)
LANGUAGES = (C, JAVASCRIPT)

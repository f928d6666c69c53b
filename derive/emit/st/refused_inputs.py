"""The refusals of inputs: each is kept as a text, which names the input and its allowed range."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.emit.st.expression import StructuredText
from derive.emit.st.layout import WIDTH, conjunction
from derive.emit.st.program import Printed
from derive.emit.st.refusal import Refusal
from derive.ir.program import Program, Require

REFUSAL = "refusal"
"""The instance variable that holds why Initialize refused."""
_REFUSING = re.compile(r"(IF NOT \([^;]*?\) THEN\n)(  refusal :=\s+'[^\n]*';\n)  RETURN;\nEND_IF\n")
_CHAIN = re.compile(rf"(?:(?://[^\n]*\n)*{_REFUSING.pattern})+")


@dataclass(frozen=True)
class OfInputs(Refusal):
    """Writes refusals of inputs, which are kept as texts."""

    texts: Mapping[str, str]
    """The text of every refusal, by the sentence of its condition."""

    def lines(self, requires: Sequence[Require], printer: StructuredText) -> list[str]:
        """The lines that refuse, for each condition separately."""
        lines: list[str] = []
        for require in requires:
            parts = [printer.print(part) for part in sp.ordered(sp.And.make_args(require.condition))]
            assert require.reason is not None
            text = self.texts[require.reason.subject.name].replace("$", "$$").replace("'", "$'")
            lines += conjunction("IF NOT (", parts, ") THEN")
            whole = f"  {REFUSAL} := '{text}';"
            refused = [whole] if len(whole) <= WIDTH else [f"  {REFUSAL} :=", f"    '{text}';"]
            lines += [*refused, "  RETURN;", "END_IF"]
        return lines


def chained(program: Printed) -> Printed:
    """The program with conditions that follow each other in one chain of ELSIF, behind which it refuses. The texts say
    what comments would.
    """

    def chain(found: re.Match[str]) -> str:
        plain = re.sub(r"^//[^\n]*\n", "", found[0], flags=re.MULTILINE)
        lines = _REFUSING.sub(r"\1\2", plain).rstrip("\n").replace("\nIF NOT (", "\nELSIF NOT (")
        return f"{lines}\nEND_IF\nIF {REFUSAL} <> '' THEN\n  RETURN;\nEND_IF\n"

    return replace(program, body=_CHAIN.sub(chain, f"{program.body}\n").rstrip("\n"))


def conditions_first(program: Program) -> Program:
    """The program with the conditions on inputs alone before all others, so that they stand together."""
    inputs = set(program.inputs)
    first = [s for s in program.body if isinstance(s, Require) and s.condition.free_symbols <= inputs]
    return replace(program, body=(*first, *(s for s in program.body if s not in first)))

"""Statements."""

from __future__ import annotations

from ..faults import Place
from .expressions import Call, Expression
from .node import node


@node
class Assign:
    target: Expression
    value: Expression
    at: Place


@node
class CallStatement:
    call: Call
    at: Place


@node
class Branch:
    condition: Expression
    body: tuple[Statement, ...]


@node
class If:
    branches: tuple[Branch, ...]
    otherwise: tuple[Statement, ...]
    at: Place


@node
class Label:
    """A value of a CASE, or a range of values when upper is given."""

    lower: Expression
    upper: Expression | None
    at: Place


@node
class CaseBranch:
    labels: tuple[Label, ...]
    body: tuple[Statement, ...]


@node
class Case:
    subject: Expression
    branches: tuple[CaseBranch, ...]
    otherwise: tuple[Statement, ...]
    at: Place


@node
class For:
    control: Expression
    start: Expression
    stop: Expression
    step: Expression | None
    body: tuple[Statement, ...]
    at: Place


@node
class While:
    condition: Expression
    body: tuple[Statement, ...]
    at: Place


@node
class Exit:
    at: Place


@node
class Return:
    at: Place


Statement = Assign | CallStatement | If | Case | For | While | Exit | Return

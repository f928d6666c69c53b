"""The types a checked text knows. Plain types compare by value, declared ones by identity."""

from __future__ import annotations

from dataclasses import dataclass, field

from . import ast


@dataclass(frozen=True)
class Boolean:
    name: str = "BOOL"


@dataclass(frozen=True)
class Integer:
    name: str
    low: int
    high: int
    size: int
    is_bits: bool = False

    def widens_to(self, other: Integer) -> bool:
        """Without a conversion only integers of the same nature widen, and only without loss."""
        return self.is_bits == other.is_bits and other.low <= self.low and self.high <= other.high


@dataclass(frozen=True)
class Real:
    name: str = "LREAL"


@dataclass(frozen=True)
class String:
    length: int

    @property
    def name(self) -> str:
        return f"STRING({self.length})"


@dataclass(frozen=True)
class Array:
    bounds: tuple[tuple[int, int], ...]
    element: Type

    @property
    def name(self) -> str:
        return f"ARRAY[{', '.join(f'{low}..{high}' for low, high in self.bounds)}] OF {self.element.name}"

    @property
    def count(self) -> int:
        count = 1
        for low, high in self.bounds:
            count *= high - low + 1
        return count


@dataclass(frozen=True)
class Pointer:
    target: Type

    @property
    def name(self) -> str:
        return f"POINTER TO {self.target.name}"


@dataclass(frozen=True)
class Opaque:
    """A library structure whose fields a text may not name: only its size is known."""

    name: str
    size: int


@dataclass(frozen=True)
class IntegerLiteral:
    """The type of a whole number in the text: it fits wherever its value fits."""

    value: int

    @property
    def name(self) -> str:
        return f"the integer {self.value}"


@dataclass(frozen=True)
class Address:
    """The result of ADR: it may become a pointer to the memory of its operand."""

    of: Type

    @property
    def name(self) -> str:
        return f"the address of a {self.of.name}"


@dataclass(frozen=True)
class NoResult:
    name: str = "nothing"


@dataclass(eq=False)
class Struct:
    name: str
    namespace: str
    fields: dict[str, Variable] = field(default_factory=dict)


@dataclass(eq=False)
class Enum:
    name: str
    namespace: str
    members: dict[str, str]
    qualified_only: bool


@dataclass(eq=False)
class Interface:
    """A variable of such a type refers to an instance of a block, or to nothing."""

    name: str
    is_queryable: bool
    """Whether it extends the interface that a query needs."""
    bases: tuple[Interface, ...] = ()
    methods: dict[str, Routine] = field(default_factory=dict)

    def method(self, name: str) -> Routine | None:
        found = self.methods.get(name)
        return found or next((m for m in (base.method(name) for base in self.bases) if m is not None), None)

    def all(self) -> frozenset[Interface]:
        return frozenset({self}).union(*(base.all() for base in self.bases))


@dataclass(eq=False)
class Block:
    name: str
    declaration: ast.Block
    base: Block | None = None
    interfaces: tuple[Interface, ...] = ()
    variables: dict[str, Variable] = field(default_factory=dict)
    methods: dict[str, Routine] = field(default_factory=dict)
    properties: dict[str, Property] = field(default_factory=dict)

    def variable(self, name: str) -> Variable | None:
        return self.variables.get(name) or (self.base.variable(name) if self.base else None)

    def method(self, name: str) -> Routine | None:
        return self.methods.get(name) or (self.base.method(name) if self.base else None)

    def property(self, name: str) -> Property | None:
        return self.properties.get(name) or (self.base.property(name) if self.base else None)

    def implemented(self) -> frozenset[Interface]:
        """The interfaces that it implements, with those that they extend and those of its base."""
        inherited = self.base.implemented() if self.base else frozenset()
        return inherited.union(*(interface.all() for interface in self.interfaces))

    def is_a(self, other: Block) -> bool:
        return self is other or (self.base is not None and self.base.is_a(other))


Type = (
    Boolean
    | Integer
    | Real
    | String
    | Array
    | Pointer
    | Opaque
    | IntegerLiteral
    | Address
    | NoResult
    | Struct
    | Enum
    | Interface
    | Block
)

BOOL = Boolean()
BYTE = Integer("BYTE", 0, 255, 1, is_bits=True)
DWORD = Integer("DWORD", 0, 2**32 - 1, 4, is_bits=True)
INT = Integer("INT", -(2**15), 2**15 - 1, 2)
UINT = Integer("UINT", 0, 2**16 - 1, 2)
DINT = Integer("DINT", -(2**31), 2**31 - 1, 4)
UDINT = Integer("UDINT", 0, 2**32 - 1, 4)
LREAL = Real()
NOTHING = NoResult()
ELEMENTARY: dict[str, Type] = {t.name: t for t in (BOOL, BYTE, DWORD, INT, UINT, DINT, UDINT, LREAL)}


def is_scalar(of: Type) -> bool:
    """Scalars are Python values; everything else is a Python object that is changed in place."""
    return not isinstance(of, (Struct, Block, Array, Opaque))


def size_of(of: Type) -> int:
    """Bytes in memory; every field of a structure stands at a multiple of its alignment."""
    if isinstance(of, (Integer, Opaque)):
        return of.size
    if isinstance(of, Boolean):
        return 1
    if isinstance(of, String):
        return of.length + 1
    if isinstance(of, Enum):
        return 2
    if isinstance(of, Array):
        return of.count * size_of(of.element)
    if isinstance(of, Struct):
        end = 0
        for variable in of.fields.values():
            end = _aligned(end, variable.type) + size_of(variable.type)
        return _aligned(end, of)
    return 8


def _alignment(of: Type) -> int:
    if isinstance(of, Struct):
        return max((_alignment(variable.type) for variable in of.fields.values()), default=1)
    if isinstance(of, Array):
        return _alignment(of.element)
    if isinstance(of, Opaque):
        return 8 if of.size % 8 == 0 else 4
    return 1 if isinstance(of, String) else size_of(of)


def _aligned(offset: int, of: Type) -> int:
    step = _alignment(of)
    return -(-offset // step) * step


# ---- what a name can mean ------------------------------------------------------------------
@dataclass(eq=False)
class Variable:
    name: str
    type: Type
    scope: str  # VAR, VAR_INPUT, VAR_OUTPUT, VAR_IN_OUT, VAR_GLOBAL, FIELD, RESULT
    constant: bool = False
    member_of: Block | None = None
    initial: ast.Expression | None = None

    @property
    def is_reference(self) -> bool:
        return self.scope == "VAR_IN_OUT"


@dataclass(eq=False)
class Routine:
    name: str
    declaration: ast.Routine
    returns: Type
    parameters: tuple[Variable, ...]
    block: Block | None = None
    namespace: str = ""
    interface: Interface | None = None


@dataclass(eq=False)
class Property:
    name: str
    type: Type
    getter: Routine


@dataclass(frozen=True)
class EnumMember:
    enum: Enum
    name: str


@dataclass(eq=False)
class Namespace:
    name: str
    entries: dict[str, Meaning]


@dataclass(frozen=True)
class Builtin:
    name: str


Meaning = Variable | Routine | Property | EnumMember | Namespace | Builtin | Type

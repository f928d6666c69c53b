"""A machine as a value: it never changes, equals any other of the same kind and parameters, and can be written down."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Set
from math import isfinite
from typing import TYPE_CHECKING, Any, Self, TypeVar, cast

from softkin._ends import Ends, ends_of, limit_names
from softkin._input import keywords_of, refuse_strange_keywords
from softkin._types import Axis, KinematicsError, Parameter, Status

_Found = TypeVar("_Found")
_KIND, _LIMITS = "mechanism", "limits"


class Value:
    """What makes a value of a machine: no attribute can be set, and its parameters are all that it is."""

    __slots__ = ("_kept",)

    NAME: str
    AXES: tuple[Axis, ...]
    PARAMETERS: tuple[Parameter, ...]
    LIMIT_KEYS: tuple[str, ...] = ()
    """What has limits of its own, by the last part of the names of their parameters: every axis in order, then other
    quantities."""
    parameters: Mapping[str, float]

    _KEYWORDS: Set[str] = frozenset()
    """The keywords of the class; empty if it takes other arguments, too."""
    _kept: tuple[frozenset[str], dict[str, Any]]
    """The names of the attributes that a subclass may not set, and what is computed when it is first needed."""

    def __init_subclass__(cls, **options: Any) -> None:
        """Every parameter becomes an attribute, unless the class already has one of that name."""
        super().__init_subclass__(**options)
        for parameter in vars(cls).get("PARAMETERS", ()):
            if not hasattr(cls, parameter.name):
                setattr(cls, parameter.name, _attribute(parameter))
        if "__init__" in vars(cls):
            cls._KEYWORDS = keywords_of(vars(cls)["__init__"])

    def __new__(cls, *places: Any, **given: Any) -> Self:
        """Raises TypeError for a parameter that the machine does not have, with the one that was perhaps meant."""
        refuse_strange_keywords(cls.__name__, cls._KEYWORDS, places, given)
        return super().__new__(cls)

    def _seal(self) -> None:
        """No attribute may be set from now on."""
        object.__setattr__(self, "_kept", (frozenset(getattr(self, "__dict__", ())), {}))

    def _once(self, name: str, make: Callable[[], _Found]) -> _Found:
        """What is computed when it is first needed, and kept."""
        kept: dict[str, Any] = self._kept[1] if hasattr(self, "_kept") else {}
        if name not in kept:
            kept[name] = make()
        return cast(_Found, kept[name])

    def _refuse_change(self, name: str) -> None:
        """Raise an error for an attribute of a complete machine; a subclass may have attributes of its own."""
        if not hasattr(self, "_kept"):
            return
        is_own = (
            "PARAMETERS" not in vars(type(self)) and name not in self._kept[0] and not hasattr(_own(type(self)), name)
        )
        if not is_own:
            raise AttributeError(
                f"{type(self).__name__}.{name} cannot be changed: make another machine, as by `changed`"
            )

    if not TYPE_CHECKING:  # a type checker would then accept any attribute

        def __setattr__(self, name: str, value: object) -> None:
            """Refuse every change of a complete machine."""
            self._refuse_change(name)
            object.__setattr__(self, name, value)

        def __delattr__(self, name: str) -> None:
            """Refuse every change of a complete machine."""
            self._refuse_change(name)
            object.__delattr__(self, name)

    def __eq__(self, other: object) -> bool:
        """Whether the other machine is of the same class, with the same parameters."""
        if type(self) is not type(other):
            return NotImplemented
        assert isinstance(other, Value)
        return self is other or self._identity() == other._identity()

    def __hash__(self) -> int:
        """A hash by value."""
        return self._once("hash", lambda: hash((type(self), tuple(self.parameters.items()))))

    def _identity(self) -> object:
        """What two machines of the same class must have in common to be equal."""
        reduced = self.__reduce__()
        return reduced[1] if isinstance(reduced, tuple) else reduced

    def __repr__(self) -> str:
        """The call that makes this machine."""
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in self._arguments())})"

    def __reduce__(self) -> tuple[Any, ...]:
        """Copying and pickling create the machine again from its parameters; a subclass keeps its own attributes."""
        return _made, (type(self), self._keywords()), self._own_state()

    def __setstate__(self, state: Mapping[str, object]) -> None:
        """Restore the attributes of a subclass."""
        for name, value in state.items():
            object.__setattr__(self, name, value)

    def _own_state(self) -> dict[str, object]:
        """The attributes that a subclass has of its own."""
        ours = self._kept[0] if hasattr(self, "_kept") else frozenset()
        found = {name: value for name, value in getattr(self, "__dict__", {}).items() if name not in ours}
        for cls in type(self).__mro__[: type(self).__mro__.index(_own(type(self)))]:
            slots = vars(cls).get("__slots__", ())
            for name in (slots,) if isinstance(slots, str) else slots:
                if name not in ("__dict__", "__weakref__") and hasattr(self, name):
                    found[name] = getattr(self, name)
        return found

    def _arguments(self) -> Iterator[tuple[str, object]]:
        """The keywords that differ from their defaults; one-sided limits are a mapping."""
        sided = self._one_sided()
        for p in self.PARAMETERS:
            if self.parameters[p.name] != p.default and p.name not in sided:
                yield p.name, self.parameters[p.name]
        if sided:
            yield _LIMITS, self._sided_limits(sided)

    def _keywords(self) -> dict[str, Any]:
        """All arguments of the call that makes this machine."""
        sided = self._one_sided()
        found: dict[str, Any] = {name: value for name, value in self.parameters.items() if name not in sided}
        return found | ({_LIMITS: self._sided_limits(sided)} if sided else {})

    def _one_sided(self) -> set[str]:
        """The names of the limits of which one end is missing."""
        keys = limit_names(self.LIMIT_KEYS, self.AXES).values()
        pairs = ((f"lower_{key}", f"upper_{key}") for key in keys)
        return {name for pair in pairs if not all(isfinite(self.parameters[n]) for n in pair) for name in pair}

    def _sided_limits(self, sided: set[str]) -> dict[str, Ends | None]:
        keys = limit_names(self.LIMIT_KEYS, self.AXES)
        return {name: ends for name, ends in self.limits.items() if f"lower_{keys[name]}" in sided}

    @property
    def limits(self) -> dict[str, Ends | None]:
        """The limits that are given: by axis (lower, upper), with None for an end without a limit; None for no limit.

        The names are those of the axes, then those of other quantities with limits. In the unit of the axis.
        """
        return ends_of(limit_names(self.LIMIT_KEYS, self.AXES), self.parameters)

    def changed(self, **parameters: Any) -> Self:
        """The same machine with other values for some parameters; `limits` changes those of the axes that it names.

        Raises NOT_INITIALIZED as the class does, TypeError for a name that is no parameter.
        """
        given = self._keywords()
        if _LIMITS in parameters and _LIMITS in given:
            parameters[_LIMITS] = given[_LIMITS] | dict(parameters[_LIMITS])
        keys = limit_names(self.LIMIT_KEYS, self.AXES)
        for name in parameters.get(_LIMITS) or ():
            for word in ("lower", "upper") if name in keys else ():
                given.pop(f"{word}_{keys[name]}", None)
        made = _made(type(self), given | parameters)
        made.__setstate__(self._own_state())
        return made

    def to_dict(self) -> dict[str, Any]:
        """The machine as plain data, for JSON or YAML: its name, its parameters and its limits, all of them."""
        keys = limit_names(self.LIMIT_KEYS, self.AXES).values()
        ends = {f"{word}_{key}" for key in keys for word in ("lower", "upper")}
        plain = {name: value for name, value in self.parameters.items() if name not in ends}
        listed = {name: None if both is None else list(both) for name, both in self.limits.items()}
        return {_KIND: self.NAME, **plain, **({_LIMITS: listed} if listed else {})}

    @classmethod
    def from_dict(cls, given: Mapping[str, Any]) -> Self:
        """The machine of `to_dict`, or of any part of it: what is missing has its default.

        `Mechanism.from_dict` makes any machine of the catalogue by its name, a class makes its own. An unknown name is
        refused, with the known ones. Raises NOT_INITIALIZED.
        """
        values = dict(given)
        name = values.pop(_KIND, None)
        found = (
            cls if "PARAMETERS" in vars(_own(cls)) and name in (None, getattr(cls, "NAME", None)) else _named(cls, name)
        )
        if found is not cls:
            return cast(Self, found.from_dict(given))
        is_radian = values.pop("in_radians", False)
        known = [p.name for p in cls.PARAMETERS]
        unknown = [key for key in values if key not in (*known, _LIMITS)]
        if unknown:
            raise _refused(f"{cls.NAME} has no parameter {unknown[0]!r}: it has {', '.join([*known, _LIMITS])}")
        missing = [p.name for p in cls.PARAMETERS if p.default is None and p.name not in values]
        if missing:
            raise _refused(f"{cls.NAME} needs {', '.join(missing)}")
        made = _made(cls, values)
        return cast(Self, cast(Any, made).in_radians()) if is_radian else made

    def to_json(self) -> str:
        """`to_dict` as JSON."""
        import json

        return json.dumps(self.to_dict())

    @classmethod
    def from_json(cls, text: str) -> Self:
        """The machine of `to_json`: see `from_dict`."""
        import json

        try:
            given = json.loads(text)
        except ValueError as error:
            raise _refused(f"{cls.__name__}: this is no JSON: {error}") from error
        if not isinstance(given, dict):
            raise _refused(f"{cls.__name__}: a machine is an object of JSON, not {given!r}")
        return cls.from_dict(given)


def _attribute(parameter: Parameter) -> property:
    """The parameter as an attribute."""
    name = parameter.name
    unit = f" [{parameter.unit}]" if parameter.unit else ""
    return property(lambda self: self.parameters[name], doc=f"{parameter.meaning}{unit}")


def _own(cls: type[Value]) -> type[Value]:
    """The class that lists the parameters, of which a user's class is a subclass."""
    return next((c for c in cls.__mro__ if "PARAMETERS" in vars(c)), Value)


_Made = TypeVar("_Made", bound=Value)


def _made(cls: type[_Made], keywords: Mapping[str, Any]) -> _Made:
    """A machine of a class, or of a subclass whose own arguments are not known."""
    own, made = _own(cls), object.__new__(cls)
    refuse_strange_keywords(own.__name__, own._KEYWORDS, (), keywords)
    own.__init__(made, **keywords)
    return made


def _named(cls: type[Value], name: object) -> type[Value]:
    """The class of a mechanism by its name: one that is loaded, or one of the catalogue."""
    from softkin import catalogue

    if not isinstance(name, str):
        raise _refused(f'which mechanism? The entry "{_KIND}" names it')
    waiting, loaded = [cls], dict[str, type[Value]]()
    while waiting:
        one = waiting.pop()
        waiting += one.__subclasses__()
        if "PARAMETERS" in vars(one) and isinstance(getattr(one, "NAME", None), str):
            loaded.setdefault(one.NAME, one)
    every: dict[str, type[Value]] = {**loaded, **catalogue()}
    found = every.get(name)
    if found is None or not issubclass(found, cls):
        raise _refused(f"{cls.__name__} cannot be made of {name!r}: the names are {', '.join(sorted(every))}")
    return found


def _refused(message: str) -> KinematicsError:
    return KinematicsError(Status.NOT_INITIALIZED, message)

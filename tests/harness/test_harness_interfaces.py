"""Interfaces of a text: variables that refer to blocks, calls through them, and the query for one."""

from typing import Any

import pytest

from tests.harness.library import StError, StFault, compile_st

COUNTS = """
INTERFACE ICounts EXTENDS __SYSTEM.IQueryInterface
METHOD Count : INT
VAR_INPUT
  iBy : INT;
END_VAR
VAR_IN_OUT
  x : LREAL;
END_VAR
VAR_OUTPUT
  xDone : BOOL;
END_VAR
END_METHOD
END_INTERFACE
"""
FURTHER = "INTERFACE IFurther EXTENDS ICounts\nMETHOD More : INT\nEND_METHOD\nEND_INTERFACE\n"
BASE = """
FUNCTION_BLOCK Base
METHOD PUBLIC Count : INT
VAR_INPUT
  iBy : INT;
END_VAR
VAR_IN_OUT
  x : LREAL;
END_VAR
VAR_OUTPUT
  xDone : BOOL;
END_VAR
x := x + 1.0;
xDone := TRUE;
Count := 2*iBy;
END_METHOD
END_FUNCTION_BLOCK
"""
TWICE = "FUNCTION_BLOCK Twice EXTENDS Base IMPLEMENTS ICounts\nEND_FUNCTION_BLOCK\n"
TOO = """
FUNCTION_BLOCK Too EXTENDS Base IMPLEMENTS IFurther
METHOD PUBLIC More : INT
More := 7;
END_METHOD
END_FUNCTION_BLOCK
"""
USER = """
PROGRAM User
VAR
  iKind : INT;
  base : Base;
  twice : Twice;
  too : Too;
  itf : ICounts;
  further : IFurther;
  xFound : BOOL;
  xDone : BOOL;
  xRefers : BOOL;
  x : LREAL;
  n : INT;
END_VAR
CASE iKind OF
  1: itf := twice;
  2: itf := too;
END_CASE
xFound := __QUERYINTERFACE(itf, further);
{body}
END_PROGRAM
"""


def user(body: str = "") -> Any:
    text = {"a": COUNTS, "b": FURTHER, "c": BASE, "d": TWICE, "e": TOO, "User": USER.replace("{body}", body)}
    return compile_st(text).new("User")


def test_a_query_finds_what_a_block_implements() -> None:
    """Nothing at first; then not what the block does not implement, whatever was found before; then what it does."""
    made = user("IF xFound THEN\n  n := further.More();\nEND_IF")
    made()
    assert made.xFound is False and made.further is None
    for kind, found, number in ((2, True, 7), (1, False, 7)):
        made.iKind = kind
        made()
        assert made.xFound is found and (made.further is not None) is found and made.n == number


def test_a_call_reaches_the_block() -> None:
    """Inputs, in-outs and outputs, of a method that the block inherits, and through an interface that extends it."""
    first = "n := itf.Count(iBy := 5, x := x, xDone => xDone);\n"
    made = user(f"{first}IF xFound THEN\n  n := n + further.Count(1, x);\nEND_IF")
    made.iKind = 1
    made()
    assert (made.n, made.x, made.xDone) == (10, 1.0, True)
    made.iKind = 2
    made()
    assert (made.n, made.x) == (12, 3.0)


def test_a_query_of_an_instance_and_into_a_local_variable() -> None:
    """Of a block itself, in a function that gets it."""
    function = """
FUNCTION Asked : INT
VAR_IN_OUT
  too : Too;
END_VAR
VAR
  own : IFurther;
END_VAR
IF __QUERYINTERFACE(too, own) THEN
  Asked := own.More();
END_IF
END_FUNCTION
"""
    library = compile_st({"a": COUNTS, "b": FURTHER, "c": BASE, "d": TOO, "Asked": function})
    assert library.function("Asked")(library.new("Too")) == 7


def test_a_call_through_nothing_is_a_fault() -> None:
    """A controller would stop there."""
    with pytest.raises(StFault, match="refers to nothing"):
        user("n := itf.Count(iBy := 5, x := x);")()


def test_whether_it_refers_to_a_block() -> None:
    """A reference that is compared with 0."""
    made = user("xRefers := (itf <> 0) AND NOT (itf = 0);")
    for kind, refers in ((0, False), (1, True)):
        made.iKind = kind
        made()
        assert made.xRefers is refers


BODIES = {
    "a comparison with a number": ("xFound := itf = 1;", "ICounts = the integer 1 is not allowed"),
    "an order of references": ("xFound := itf > 0;", "is not allowed"),
    "a block that does not implement it": ("itf := base;", "Base does not fit ICounts"),
    "an interface that it does not extend": ("further := itf;", "ICounts does not fit IFurther"),
    "a method that it does not have": ("n := itf.More();", "ICounts has no method More"),
    "a field": ("n := itf.n;", "ICounts has no field n"),
    "a query of a number": ("xFound := __QUERYINTERFACE(n, further);", "INT is no reference"),
    "a query into a number": ("xFound := __QUERYINTERFACE(itf, n);", "INT is no reference"),
    "a query into nothing": ("xFound := __QUERYINTERFACE(itf);", "takes two arguments"),
    "a query into a result": ("n := __QUERYINTERFACE(itf, further);", "BOOL does not fit INT"),
    "another name with two underscores": ("xFound := __QUERYPOINTER(itf, further);", "double underscore"),
    "the namespace of the system": ("xFound := __SYSTEM.IQueryInterface;", "double underscore"),
    "a missing argument": ("n := itf.Count(iBy := 5);", "argument x of Count is missing"),
}


@pytest.mark.parametrize("case", BODIES)
def test_what_is_refused(case: str) -> None:
    """Every rule is shown by a statement that breaks it."""
    body, message = BODIES[case]
    with pytest.raises(StError, match=message):
        user(body)


DECLARATIONS = {
    "a body": ("METHOD M : BOOL\nM := TRUE;\nEND_METHOD", "without a body"),
    "an access": ("METHOD PUBLIC M : BOOL\nEND_METHOD", "without an access"),
    "two methods of one name": ("METHOD M\nEND_METHOD\nMETHOD m\nEND_METHOD", "duplicate name m"),
    "a keyword": ("METHOD M\nVAR_INPUT\n  r : LREAL;\nEND_VAR\nEND_METHOD", "r is a word of the language"),
    "an unknown type": ("METHOD M\nVAR_INPUT\n  x : Nothing;\nEND_VAR\nEND_METHOD", "unknown type Nothing"),
}


@pytest.mark.parametrize("case", DECLARATIONS)
def test_what_an_interface_cannot_have(case: str) -> None:
    """Methods alone, and those as headers alone."""
    members, message = DECLARATIONS[case]
    with pytest.raises(StError, match=message):
        compile_st({"I": f"INTERFACE I1 EXTENDS __SYSTEM.IQueryInterface\n{members}\nEND_INTERFACE\n"})


def test_an_interface_of_the_library_is_known() -> None:
    """A reference to one, and the query of one that is documented as open to a query."""
    text = """
PROGRAM User
VAR
  kin : TRAFO.MC_KIN_REF_SM3;
  part : TRAFO.ISMPositionKinematics2;
  image : TRAFO.ISMKinematicsWithOrientationImage2;
  xFound : BOOL;
END_VAR
xFound := __QUERYINTERFACE(kin, part);
END_PROGRAM
"""
    made = compile_st({"User": text}).new("User")
    made()
    assert made.xFound is False
    with pytest.raises(StError, match="does not extend __SYSTEM.IQueryInterface"):
        compile_st({"User": text.replace("part);", "image);")})

"""What a live connection is told: machines of every origin, nodes, scales, addresses; and that no password is taken."""

import json
import sys
from pathlib import Path
from typing import Any

import pytest
import softkin

from derive.controller.addresses import Address, Kind, address_of
from derive.controller.channels import Channel, of_argument
from derive.controller.credentials import Credentials, credentials
from derive.controller.machine import machine_of
from derive.controller.messages import about_the_machine
from derive.controller.refusal import Refused
from derive.controller.run import source_of, who
from derive.controller.settings import Security, Settings, settings_of
from derive.description.catalogue import catalogue
from tests.command.files import RAIL, ROOT
from tests.controller.pages import GANTRY, settings

OPC = "opc.tcp://127.0.0.1:4840"
NODES = {"X": "ns=2;s=x", "Y": "ns=2;s=y"}


def refusal(folder: Path, given: Any, *nodes: str, **source: Any) -> str:
    path = folder / "machine.json"
    path.write_text(given if isinstance(given, str) else json.dumps(given), encoding="utf-8")
    with pytest.raises(Refused) as problem:
        settings_of(path, nodes, source)
    assert "\n" not in str(problem.value)
    return str(problem.value)


def test_every_machine_of_the_catalogue_as_its_class_writes_it() -> None:
    """Axes and units are those of the class; so are the parameters that are known, and those that are needed."""
    for _, mechanism in catalogue():
        cls = softkin.catalogue()[mechanism.name]
        robot = cls(**{p.name: p.nominal for p in mechanism.parameters if p.fixed is None})
        machine = machine_of(json.loads(robot.to_json()), None, None)
        assert [(a.name, a.unit) for a in machine.axes] == [(a.name, a.unit) for a in robot.AXES], mechanism.name
        assert machine.given == robot.to_dict()
        for parameter in cls.PARAMETERS:
            if parameter.default is None:
                given = {name: value for name, value in robot.to_dict().items() if name != parameter.name}
                with pytest.raises(Refused, match=f"{mechanism.name} needs {parameter.name}"):
                    machine_of(given, None, None)


def test_couplings_tools_and_bases() -> None:
    """Their axes are those of the Python package, in its order and by its names."""
    gantry = softkin.Coupled(softkin.Gantry3(), softkin.CAxis())
    raised = softkin.Frame((0.0, 0.0, 1.0))
    for robot in (gantry, softkin.Gantry2().with_tool(raised), gantry.with_base(raised)):
        machine = machine_of(robot.to_dict(), None, None)
        assert machine.axis_names == tuple(a.name for a in robot.AXES)
        assert softkin.Mechanism.from_dict(machine.given) == robot
    scara = softkin.Scara4ZCcoupledType1(link_length_1=2.0, link_length_2=1.0, pitch_zc=1.0)
    twice = {"mechanism": "Coupled", "position": scara.to_dict(), "orientation": scara.to_dict()}
    assert machine_of(twice, None, None).axis_names[3:5] == ("A4", "orientation A1")
    for wrong in ({"mechanism": "Coupled"}, {"mechanism": "Coupled", "position": 7}, {"mechanism": "Mounted"}):
        with pytest.raises(Refused, match="needs an entry"):
            machine_of(wrong, None, None)


def test_machines_of_a_users_own(tmp_path: Path) -> None:
    """By their description, or by a package: names and values that cannot be are refused by both."""
    (tmp_path / "my_rail.py").write_text(RAIL, encoding="utf-8")
    source = {"source": "-"}
    own = {"description": "my_rail.py", **source}
    told = settings(tmp_path, {**own, "machine": {"offset_a1": 2.0}})
    assert told.machine.axis_names == ("A1", "A2") and [a.unit for a in told.machine.axes] == ["u", "u"]
    assert told.machine.given == {"mechanism": "Rail", "offset_a1": 2.0}
    assert settings(tmp_path, own).machine.given == {"mechanism": "Rail"}
    assert "offset_a3" in refusal(tmp_path, {**own, "machine": {"offset_a3": 2.0}})
    assert "not both" in refusal(tmp_path, {**own, "package": "build"})
    assert "describes Rail, not 'Rails'" in refusal(tmp_path, {**own, "machine": "Rails"})
    assert "there is no such file" in refusal(tmp_path, {"description": "rail.py", **source})
    package = {"package": str(ROOT / "generated/python/softkin"), **source}
    told = settings(tmp_path, {**package, "machine": {"mechanism": "Kin_Polar_Z", "upper_c": 7.0, "lower_c": 1.0}})
    assert [(a.name, a.unit) for a in told.machine.axes] == [("C", "deg"), ("R", "u"), ("Z", "u")]
    assert "which mechanism?" in refusal(tmp_path, package)
    assert "offset_x3" in refusal(tmp_path, {**package, "machine": {"mechanism": "Kin_Gantry2", "offset_x3": 2.0}})
    assert "there is no package" in refusal(tmp_path, {"package": "build/python", **source})
    (tmp_path / "softkin").mkdir()
    (tmp_path / "softkin/__init__.py").touch()
    assert "the package softkin is that of" in refusal(tmp_path, {"package": "softkin", **source})


@pytest.mark.parametrize(
    ("text", "channel"),
    [
        ("A1=ns=4;s=|var|PLC.GVL.axis[1].fPos", Channel("A1", "ns=4;s=|var|PLC.GVL.axis[1].fPos")),
        ("A1=ns=2;i=7*-0.001", Channel("A1", "ns=2;i=7", -0.001)),
        ("A1 = motion/axs/X * 57.29577951308232", Channel("A1", "motion/axs/X", 57.29577951308232)),
        ("A1=a*b*2", Channel("A1", "a*b", 2.0)),
    ],
)
def test_nodes_of_the_command_line(text: str, channel: Channel) -> None:
    """The axis stands before the first `=`, the scale behind the last `*`."""
    assert of_argument(text) == channel


@pytest.mark.parametrize("text", ["A1", "=n", "A1=", "A1=*2", "A1=n*", "A1=n*x", "A1=n*0", "A1=n*nan", "A1=n*inf"])
def test_nodes_that_cannot_be(text: str) -> None:
    """Refused with what was typed."""
    with pytest.raises(Refused, match="--axis"):
        of_argument(text)


def test_nodes_of_the_json_and_of_the_command_line(tmp_path: Path) -> None:
    """In the order of the machine; the command line comes last; a column is called as its axis."""
    given = {**GANTRY, "source": OPC, "axes": {"Y": {"node": "ns=2;s=y", "scale": 2}, "X": "ns=2;s=x*2"}}
    assert settings(tmp_path, given).channels == (Channel("X", "ns=2;s=x*2"), Channel("Y", "ns=2;s=y", 2.0))
    told = settings(tmp_path, given, None, "Y=ns=3;s=y*0.5")
    assert told.channels[1] == Channel("Y", "ns=3;s=y", 0.5)
    told = settings(tmp_path, {**GANTRY, "source": "t.csv", "axes": {"Y": {"scale": 2}}})
    assert told.channels == (Channel("X", "X"), Channel("Y", "Y", 2.0))
    assert "which node is Y? Name it with --axis Y=node" in refusal(tmp_path, {**GANTRY, "source": OPC}, "X=ns=2;s=x")
    assert "no axis 'Z': its axes are X, Y" in refusal(tmp_path, {**GANTRY, "source": OPC, "axes": {"Z": "n"}})
    for wrong in (7, None, {"nodes": "n"}, {"node": 7}, {"node": "n", "scale": "2"}, {"node": "n", "scale": True}, ""):
        assert "axes.X" in refusal(tmp_path, {**GANTRY, "source": OPC, "axes": {"X": wrong}})


def test_the_source_and_what_is_told_about_it(tmp_path: Path) -> None:
    """Defaults, the JSON, the command line; a path in the JSON starts beside it."""
    source = {"address": "t.csv", "rate": 20, "speed": 2, "loop": True, "time": "ms*0.001", "ca": "ca.pem"}
    told = settings(tmp_path, {**GANTRY, "source": source})
    assert (told.rate, told.stale_after, told.speed, told.is_loop) == (20.0, 1.0, 2.0, True)
    assert told.time == Channel("time", "ms", 0.001) and told.security.ca == tmp_path / "ca.pem"
    assert told.address == Address(Kind.TABLE, str(tmp_path / "t.csv"))
    path = tmp_path / "machine.json"
    typed = settings_of(path, (), {"address": "u.csv", "rate": 5.0, "speed": None, "loop": None}, Security(Path("c")))
    assert (typed.address.text, typed.rate, typed.speed, typed.security.ca) == ("u.csv", 5.0, 2.0, Path("c"))
    assert settings(tmp_path, {**GANTRY, "source": {**source, "time": {"node": "ms"}}}).time == Channel("time", "ms")
    for wrong in ({"rate": 0}, {"rate": "50"}, {"rate": True}, {"stale_after": -1}, {"speed": 1e9}, {"loop": 1}):
        assert next(iter(wrong)) in refusal(tmp_path, {**GANTRY, "source": {**source, **wrong}})
    for wrong in ({"time": 7}, {"time": {"node": "t", "scale": 0}}, {"ca": 7}, {"more": 1}):
        assert next(iter(wrong)) in refusal(tmp_path, {**GANTRY, "source": {**source, **wrong}})
    assert "where do the values come from?" in refusal(tmp_path, GANTRY)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("", "no JSON"),
        ("[]", "an object of JSON, not list"),
        pytest.param("[" * 60_000, "no JSON: it is too deeply nested", id="deep"),
        ({**GANTRY, "axes": {"X": {"scale": 10**400}}, "source": "-"}, "axes.X: a scale is a number other than 0"),
        ({**GANTRY, "source": {"address": "-", "rate": 10**400}}, "rate is a number"),
        ('{"machine": {"mechanism": "Kin_Gantry2"}, "machine": {}}', "the entry 'machine' stands twice"),
        ('{"machine": {"mechanism": "Kin_Gantry2", "offset_x": NaN}}', "NaN is no finite number"),
        ('{"machine": {"mechanism": "Kin_Gantry2", "offset_x": 1e999}}', "1e999 is no finite number"),
        ({"machines": {}}, "there is no entry 'machines'"),
        ({"source": "-"}, "which machine?"),
        ({"machine": 7, "source": "-"}, "a machine is"),
        ({"machine": "Kin_Gantry9", "source": "-"}, "'Kin_Gantry9' is no mechanism of the catalogue"),
        ({"machine": {"mechanism": "Kin_Gantry2", "more": 1}, "source": "-"}, "has no parameter 'more'"),
        ({"machine": {"mechanism": "Kin_Gantry2", "offset_x": "1"}, "source": "-"}, "offset_x is a number, not '1'"),
        ({"machine": {"mechanism": "Kin_Gantry2", "in_radians": True}, "source": "-"}, "leave in_radians out"),
        ({**GANTRY, "axes": [], "source": "-"}, "axes is an object"),
        ({**GANTRY, "source": 7}, "source is an address"),
        ({**GANTRY, "description": 7, "source": "-"}, "description is the path of a file"),
    ],
)
def test_a_file_that_is_wrong(given: Any, said: str, tmp_path: Path) -> None:
    assert said in refusal(tmp_path, given)


def test_a_machine_alone_as_python_writes_it(tmp_path: Path) -> None:
    """The file of `to_json`: nodes and source then come from the command line. A block's name is a name, too."""
    path = tmp_path / "gantry.json"
    path.write_text(softkin.Gantry2(offset_x=3.0).to_json(), encoding="utf-8")
    told = settings_of(path, ["X=ns=2;s=x", "Y=ns=2;s=y*2"], {"address": OPC})
    assert told.machine.given["offset_x"] == 3.0 and told.address.kind is Kind.OPC_UA
    first = json.loads(about_the_machine(told))
    assert first["machine"] == softkin.Gantry2(offset_x=3.0).to_dict() and first["name"] == "Kin_Gantry2"
    assert machine_of("Softkin_Gantry2", None, None).given == {"mechanism": "Kin_Gantry2"}


SECRET = "s3cr3t"


@pytest.mark.parametrize(
    "address",
    [
        f"opc.tcp://me:{SECRET}@plc:4840",
        f"opc.tcp://{SECRET}@plc:4840",
        f"https://me:{SECRET}@plc",
        f"https://plc/?password={SECRET}",
        f"https://plc#{SECRET}",
        f"opc.tcp://plc:4840?user=me&password={SECRET}",
        f"http://me:{SECRET}@plc",
        f"opc.tcp://me:{SECRET}@[plc",
        f"opc.tcp://plc:{SECRET}",
        f"https://plc/{SECRET}",
        f"opc.tcp:/me:{SECRET}@plc",
        f"me:{SECRET}@plc",
        f"opc.tcp:{SECRET}",
    ],
)
def test_a_url_with_a_password_is_refused_and_not_repeated(address: str, tmp_path: Path) -> None:
    """From the command line and in the JSON."""
    given = {**GANTRY, "axes": NODES}
    assert SECRET not in refusal(tmp_path, {**given, "source": {"address": address, "more": 1}})
    for said in (refusal(tmp_path, {**given, "source": address}), refusal(tmp_path, given, address=address)):
        assert SECRET not in said and len(said) > 30


@pytest.mark.parametrize("name", ["password", "Password", "pass_word", "PWD", "user", "user-name", "token", "api_key"])
def test_a_file_with_a_password_is_refused(name: str, tmp_path: Path) -> None:
    """Wherever it stands."""
    given = {**GANTRY, "axes": NODES, "source": {"address": OPC}}
    for place in (given, given["source"], given["axes"], given["machine"]):
        place[name] = SECRET  # type: ignore[index]
        said = refusal(tmp_path, given)
        assert "credentials do not belong into a file" in said and "SOFTKIN_PASSWORD" in said and SECRET not in said
        del place[name]  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("http://plc", "http://plc is not encrypted: a ctrlX answers at https://plc"),
        ("ftp://plc", "ftp:// is no source"),
        ("https://", "names no host"),
        ("https://plc/automation", "the address of a ctrlX is https://plc"),
    ],
)
def test_addresses_that_are_none(text: str, said: str) -> None:
    with pytest.raises(Refused, match=said):
        address_of(text, Path())


def told(address: str, security: Security) -> Settings:
    machine = machine_of("Kin_Gantry2", None, None)
    return Settings(machine, (Channel("X", "x"), Channel("Y", "y")), address_of(address, Path()), security)


def test_credentials(monkeypatch: pytest.MonkeyPatch) -> None:
    """From the environment, else asked at a terminal, else refused; and never sent unencrypted."""
    monkeypatch.delenv("SOFTKIN_USER", raising=False)
    monkeypatch.delenv("SOFTKIN_PASSWORD", raising=False)
    assert who(told(OPC, Security())) is None and who(told("-", Security(logs_in=True))) is None
    with pytest.raises(Refused, match="https://plc wants a user and a password: set SOFTKIN_USER and SOFTKIN_PASSWORD"):
        who(told("https://plc", Security()))
    monkeypatch.setattr("sys.stdin.isatty", lambda: True, raising=False)
    asked: list[str] = []
    monkeypatch.setattr("builtins.input", lambda text: asked.append(text) or "me")
    monkeypatch.setattr("getpass.getpass", lambda text: asked.append(text) or SECRET)
    assert who(told(OPC, Security(logs_in=True))) == Credentials("me", SECRET)
    assert asked == [f"User at {OPC}: ", f"Password of me at {OPC}: "]
    monkeypatch.setenv("SOFTKIN_USER", "you")
    assert credentials("plc") == Credentials("you", SECRET) and asked[2:] == ["Password of you at plc: "]
    monkeypatch.setenv("SOFTKIN_PASSWORD", "other")
    assert who(told(OPC, Security())) == Credentials("you", "other")
    assert "other" not in repr(credentials("plc"))
    with pytest.raises(Refused, match="a password is never sent unencrypted"):
        who(told(OPC, Security(is_unencrypted=True)))


@pytest.mark.parametrize("address", [OPC, "https://plc"])
def test_a_missing_package_names_the_extra(address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is not installed is said with what to install."""
    for name in ("asyncua", "aiohttp"):
        monkeypatch.setitem(sys.modules, name, None)
    for name in ("opc_ua", "opc_ua_trust", "data_layer"):
        monkeypatch.delitem(sys.modules, f"derive.controller.sources.{name}", raising=False)
    with pytest.raises(Refused, match=r"of the extra `live` are missing: pip install 'softkin-compiler\[live\]'"):
        source_of(told(address, Security()), Credentials("me", SECRET))

"""The viewer in a notebook: its page stands in the output, packed, and starts with one machine."""

from __future__ import annotations

import gzip
import json
import re
from base64 import b64encode
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import quote

from softkin._input import reals
from softkin._mounted import Mounted
from softkin._scalar import RADIAN
from softkin._types import KinematicsError, Numbers, Status

if TYPE_CHECKING:
    from softkin._core import Mechanism

_PAGE = Path(__file__).with_name("_viewer.html")
"""The page that a wheel carries."""
_UNPACKED = """<!doctype html><script>
const bytes = Uint8Array.from(atob("PACKED"), (one) => one.charCodeAt(0));
new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text().then((text) => {
  document.open();
  document.write(text);
  document.close();
});
</script>"""
"""A page that unpacks another one: Chromium shows no frame whose address is longer than two megabytes."""
_DATA = re.compile(r'<script type="application/json" id="page">(.*?)</script>', re.DOTALL)


class View:
    """A machine in the viewer. A notebook shows it; `url` holds the whole page."""

    def __init__(self, name: str, url: str) -> None:
        self.name, self.url = name, url

    def __repr__(self) -> str:
        """The machine."""
        return f"<View of {self.name}: a notebook shows it>"

    def _repr_html_(self) -> str:
        """A frame with the page."""
        return f'<iframe src="{self.url}" width="100%" height="640" style="border: 0"></iframe>'


def view(robot: Mechanism, axes: Numbers | None, page: str | PathLike[str] | None) -> View:
    """See `Mechanism.view`."""
    source = _PAGE if page is None else Path(page)
    if not source.is_file():
        where = "the page of the viewer did not come with this installation" if page is None else f"there is no {page}"
        made = "`make view` in the folder of Softkin writes build/viewer.html"
        remedy = "give it as page=; for a machine of your own, give the page that `softkin view` writes"
        raise KinematicsError(Status.NOT_INITIALIZED, f"{robot.NAME}.view: {where}: {made}; {remedy}")
    machine, text = robot.in_degrees(), source.read_text(encoding="utf-8")
    machine = machine.bare.in_degrees() if isinstance(machine, Mounted) else machine
    found = _DATA.search(text)
    data = json.loads(found[1]) if found else {}
    if machine.NAME not in data.get("classes", {}):
        raise KinematicsError(Status.NOT_INITIALIZED, f"{robot.NAME}.view: {source} does not have this machine")
    there = {ours: theirs for theirs, ours in data["keywords"].get(machine.NAME, {}).items()}
    given = (f"{quote(there.get(name, name))}:{float(value)!r}" for name, value in machine.parameters.items())
    parts = [f"machine={quote(machine.NAME)}", f"with={','.join(given)}"]
    if axes is not None:
        factors = (RADIAN if axis.unit == "rad" else 1.0 for axis in robot.AXES)
        values = zip(reals(axes, len(robot.AXES), "axes"), factors, strict=True)
        parts.append(f"axes={','.join(repr(value * factor) for value, factor in values)}")
    packed = b64encode(gzip.compress(text.encode(), mtime=0)).decode()
    whole = b64encode(_UNPACKED.replace("PACKED", packed).encode()).decode()
    return View(robot.NAME, f"data:text/html;base64,{whole}#{'&amp;'.join(parts)}")

"""A robot as a tree of links: its ends, and the joints on the way between two links."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from derive.importing.formats.loops import Loop
from derive.importing.robot import UnreadableRobot


@dataclass(frozen=True)
class Edge:
    """A joint between two links."""

    name: str
    parent: str
    child: str


def ends_of(
    path: Path, edges: Sequence[Edge], links: Sequence[str], base: str | None, tip: str | None
) -> tuple[str, str]:
    """The base and the tip: as named, or the only root and the only end of the tree."""
    _refuse_twice(path, "link", links)
    _refuse_twice(path, "joint", [e.name for e in edges])
    known = set(links)
    for edge in edges:
        for link in (edge.parent, edge.child):
            if link not in known:
                raise UnreadableRobot(f"{path}: joint {edge.name!r} names the link {link!r}, which the file has not")
    for word, named in (("base", base), ("tip", tip)):
        if named is not None and named not in known:
            raise UnreadableRobot(f"{path}: no link is called {named!r} (--{word}); there are {listed(links)}")
    children, parents = {e.child for e in edges}, {e.parent for e in edges}
    roots = [link for link in links if link not in children]
    ends = [link for link in links if link not in parents]
    return base or _only(path, "base", roots), tip or _only(path, "tip", _below(edges, ends, base))


def _below(edges: Sequence[Edge], ends: list[str], base: str | None) -> list[str]:
    """The ends that are reached from the base."""
    if base is None:
        return ends
    reached, size = {base}, 0
    while len(reached) != size:
        size = len(reached)
        reached |= {e.child for e in edges if e.parent in reached}
    return [end for end in ends if end in reached]


def _only(path: Path, word: str, links: list[str]) -> str:
    if len(links) == 1:
        return links[0]
    if not links:
        raise UnreadableRobot(f"{path}: its links form a closed chain: no link is the {word}")
    raise UnreadableRobot(f"{path}: has {len(links)} possible {word} links: choose with --{word}: {listed(links)}")


def listed(names: Sequence[str], most: int = 40) -> str:
    """Names of a file in a message; of many the first ones."""
    return ", ".join([*names[:most], *(["…"] if len(names) > most else [])])


def _refuse_twice(path: Path, word: str, names: Iterable[str]) -> None:
    for name, count in Counter(names).items():
        if count > 1:
            raise UnreadableRobot(f"{path}: two {word}s are called {name!r}")


def tree_of(edges: Sequence[Edge]) -> tuple[dict[str, Edge], tuple[Loop, ...]]:
    """The joint above each link, and the loops that a second joint above a link closes."""
    above: dict[str, Edge] = {}
    loops = []
    for edge in edges:
        if edge.child in above:
            loops.append(Loop(f"joint {edge.name!r}", edge.parent, edge.child))
        else:
            above[edge.child] = edge
    return above, tuple(loops)


def path_between(path: Path, above: Mapping[str, Edge], base: str, tip: str) -> list[tuple[Edge, bool]]:
    """The joints from the base to the tip, each with whether it is passed from its child to its parent.

    above: the joint above each link. Raises `UnreadableRobot` if there is no way.
    """
    if base == tip:
        raise UnreadableRobot(f"{path}: base and tip are the same link, {base!r}")
    up, down = _to_root(path, above, base), _to_root(path, above, tip)
    if (up[-1].parent if up else base) != (down[-1].parent if down else tip):
        raise UnreadableRobot(f"{path}: no way leads from {base!r} to {tip!r}")
    while up and down and up[-1] == down[-1]:
        up.pop()
        down.pop()
    return [*((edge, True) for edge in up), *((edge, False) for edge in reversed(down))]


def _to_root(path: Path, above: Mapping[str, Edge], link: str) -> list[Edge]:
    found: dict[str, Edge] = {}
    while link in above:
        if link in found:
            raise UnreadableRobot(f"{path}: its links form a closed chain: {link!r} is below itself")
        found[link] = above[link]
        link = above[link].parent
    return list(found.values())

"""The user name and the password: read from the environment or at a terminal; never from a file, and never shown."""

from __future__ import annotations

import getpass
import os
import sys
from dataclasses import dataclass, field

from derive.controller.addresses import PASSWORD, USER
from derive.controller.refusal import Refused


@dataclass(frozen=True)
class Credentials:
    """Who logs in."""

    user: str
    password: str = field(repr=False)


def are_given() -> bool:
    """Whether the environment names a user."""
    return bool(os.environ.get(USER))


def credentials(place: str) -> Credentials:
    """The credentials of the environment; missing ones are asked for. Raises `Refused` if there is no terminal."""
    user, password = os.environ.get(USER), os.environ.get(PASSWORD)
    if (not user or password is None) and not sys.stdin.isatty():
        raise Refused(f"{place} wants a user and a password: set {USER} and {PASSWORD}, or run it at a terminal")
    user = user or input(f"User at {place}: ")
    return Credentials(user, getpass.getpass(f"Password of {user} at {place}: ") if password is None else password)

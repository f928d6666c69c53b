"""The one form of a machine: the rules, in their order."""

from __future__ import annotations

from collections.abc import Mapping

from derive.description.amounts import with_exact_angles
from derive.description.mechanism import Mechanism
from derive.form.chain import with_normal_chain
from derive.form.exact import with_exact_numbers
from derive.form.gears import with_gears
from derive.form.inner_names import with_inner_names
from derive.form.loop_angles import with_named_loop_angles
from derive.form.numbers import with_named_numbers
from derive.form.rods import with_plain_rods


def in_form(mechanism: Mechanism, further: Mapping[str, int] | None = None) -> Mechanism:
    """The mechanism in its one form.

    further: the symbols of parameters and joints whose names equalled a derived one in earlier attempts, and how often.
    """
    own = with_normal_chain(with_exact_angles(with_inner_names(mechanism, further)))
    geared = with_gears(own)  # a turn written in two parts is one by now
    return with_named_numbers(with_named_loop_angles(with_plain_rods(with_exact_numbers(geared))))

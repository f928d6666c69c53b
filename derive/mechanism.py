"""The vocabulary of a description: joints, parameters, closure, task, branches; for mechanism files to import."""

from derive.description import mechanism as _described
from derive.description.mechanism import *  # noqa: F403
from derive.ir.constants import DEGREE

__all__ = ["DEGREE"]
__all__ += _described.__all__

"""The search: bounded loops, each pass of which makes one step.

find: one loop, each pass of which makes one step of what the search is at
near: the solution next to the reference, for which nothing is searched
parts: a step around the circle on which the wave does not vanish
rounds: ways around the circle, each with other values of angles that are nearly free
starts: the starts in a part of the circle in which the wave may vanish
tried: the trials in a part: the shortest length, the least residual next to a start
twins: two solutions that stand at one root
"""

"""Reports on a mechanism, for emitted files and for readers: reasons, costs, self-tests, the derivation step by step.

It may import the folders from `ir` to `kinematics`.

branch_meanings: the meanings of derived branches and assembly modes, in words and at one pose
branch_stretches: parts of a branch that other branches share
call_cost: the cost of one call: with every branch named, and of a case of the self-test
cost: the cost of programs, and of every kind of call, in the worst case
demo: a line that the nominal machine can follow, for a demonstration
derived: the derivation, repeated for a reader
reasons: the reasons of refusals in words
reference_calls: the answers of the methods of a block, by the reference interpreter
self_test: the calls of the self-test, with their answers
singular_poses: poses in which one margin vanishes
workspace_map: slices through the workspace: solutions and margins at each point
"""

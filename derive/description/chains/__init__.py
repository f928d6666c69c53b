"""The contents of a chain: its amounts are checked, its numbers get names, its gears are moved to the joints.

Like `description`, it may import `ir`, `algebra` and `geometry`.

amounts: the amounts of turns and shifts: how they are written, and which of them are refused
gears: gears that stand in a chain, moved to the joints
numbers: names for the numbers that stand in a chain
turns: angles that stand in a chain as numbers: right angles are recognised, all others get names
"""

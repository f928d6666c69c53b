"""What stands in a chain: its amounts, checked; its numbers, under names; its gears, moved to the joints.

Like `description`, it may import `ir`, `algebra` and `geometry`.

amounts: the amounts of turns and shifts: how they are written, and which are refused
gears: gears that stand in a chain, moved to the joints
numbers: numbers that stand in a chain, under names
turns: angles that stand in a chain as numbers: right angles recognised, all others under names
"""

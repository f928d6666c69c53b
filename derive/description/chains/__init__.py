"""What stands in a chain: its amounts, checked; its numbers under names; its gears, moved to the joints."""

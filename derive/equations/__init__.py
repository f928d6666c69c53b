"""What has to be solved: the closure in the coordinates of the task, chains split on both sides, axes and their
periods."""

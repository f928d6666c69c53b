"""`make prove-linuxcnc`: the generated kinematics modules in the real LinuxCNC of Debian, without a screen.

* `packages` downloads LinuxCNC and unpacks it into a folder; nothing is installed.
* `room` is a private view of this computer, in which /usr and /etc have LinuxCNC as well.
* `machines` are seven, what each is asked to do, and where it has to refuse; `modules` has the compiler write theirs.
* `settings` are the INI and HAL files of one; `session` runs it, from the start of LinuxCNC to the record.
* `display` runs as LinuxCNC's screen, inside alone: it homes, runs programs, and records.
* `twin` holds the record against the Python package, with `poses` (frames, and the way that a program describes).
* `documented` runs the configuration of the guide.
* `verdict` judges, `table` prints.
"""

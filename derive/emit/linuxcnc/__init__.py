"""Kinematics modules of LinuxCNC: one C source a mechanism, written on demand around the output of `c`.

It may import the folders of `emit` but `page`, `softmotion` and `st`. The calls of LinuxCNC and its HAL stand in
`runtime/linuxcnc`.

package: the source of a mechanism, which needs no other
tool: the length of the tool, which way it points, and what a table turns
words: the meaning of each coordinate of a LinuxCNC pose on a machine
"""

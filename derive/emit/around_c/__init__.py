"""Controllers that take the C of a machine with a file around it: Klipper, B&R mapp Motion.

package: a controller as data, and its files
wire_frame: the lines of a drawing, in C
"""

"""Function blocks for SoftMotion: their interfaces, methods, settings, self-tests and their overview.

It may import the folders of `emit` but `page`. `Initialize` reads all inputs of a block (`ReadInputs`), and computes
the values that depend on them alone. Besides it only `AxisSettings` writes variables of a block: several tasks may call
every other method at once.

base: the base block: the methods that no geometry changes
block: the data of a block that templates read
calls: the programs of a block without the steps that the base block does
description: the comment of a block, which the SoftMotion configurator shows
inputs: the inputs of a block: type, default, range, unit
instructions: what a call takes on processors of controllers, as it was counted
library: all files: text, PLCopenXML and the import script
methods: the methods of a block, and the spelling of the values that they read
pictures: the pictures in the descriptions of blocks, and the overview
sample: a sample project: a program that moves the machine, a panel to jog it, and its drawing that moves
self_test: the self-test of a block, as tables of calls and answers
"""

"""The vocabulary of a mechanism, and the checks of a description.

It may import `ir`, `algebra` and `geometry`. Mechanism files import it as `derive.mechanism` and its neighbours.

amounts: the amounts in a chain and in equations: exact angles, other symbols, and which are refused
branches: branches and assembly modes: two solutions that the sign of an indicator tells apart
catalogue: the mechanism files of a folder, loaded and checked
dimensions: the parameters of a machine by their roles, and conditions between them
drives: loops that move joints of a chain: cylinders, cranks with rods
errors: the error of a description that cannot be right, and text of files as a terminal may print it
fields: the kinds of values that the fields and parts of a mechanism hold
joints: how joints move, what their values mean, their ranges; notes on held and surplus ones, and on what they decide
loops: the parts of a closed loop: rods, planes that guide points, bounds and limits of quantities
mechanism: the mechanism with its task, and all names that a description uses
places: the line of a description that is wrong
quantity: joints and parameters as symbols in equations
reach: arms that reach a common point; struts or cables that meet in one, surplus ones, their load
remedies: what to do about a refusal whose own sentence does not say it
validate: checks that refuse a wrong description before anything is derived
"""

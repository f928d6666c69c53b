"""Expressions in the sines and cosines of angles, in a form in which equal ones look alike.

It may import `ir`.

angle_sums: names of sums of angles, and the addition theorems read backwards
normal_form: polynomials in sines and cosines, modulo sin² + cos² = 1
rings: expressions with rational numbers, expanded in a ring of polynomials, which is faster
"""

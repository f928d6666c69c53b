"""One question to each language that is asked through `Language`: what holds in Python holds there.

language: C and JavaScript, and how each is asked. Faults that are planted are in the folder of each language, and so is
what one language alone can be given.
"""

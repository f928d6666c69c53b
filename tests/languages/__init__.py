"""One question to each language that is asked through `Language`: what holds in Python holds there.

language: C and JavaScript, and how each is asked. What one language alone can be given is in its
folder.
"""
